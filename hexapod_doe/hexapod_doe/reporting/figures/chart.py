# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""One figure of the report, and its three forms: SVG in the page, PNG and CSV beside it."""

import io
import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib as mpl
import pandas as pd
from matplotlib.figure import Figure

from hexapod_doe.reporting.figures.style import RC, ROLES
from hexapod_doe.sheets.write import write_csv

_VARIABLES = {values[0]: f'var(--{role})' for role, values in ROLES.items()}
_COLOUR = re.compile('|'.join(_VARIABLES))
_PNG_DPI = 160


@dataclass(frozen=True)
class Chart:
    """A figure that has not been drawn yet."""

    name: str
    """Stem of its files and anchor in the page."""
    title: str
    """What it shows, as a sentence."""
    caption: str
    """How to read it."""
    data: pd.DataFrame
    """The numbers that are drawn."""
    draw: Callable[[], Figure]
    half: bool = False
    """Whether it takes half the width of a page, beside another one."""

    def save(self, figures: Path, tables: Path) -> None:
        """Write the PNG, with the title in it, and the CSV."""
        with mpl.rc_context(RC):
            figure = self.draw()
            figure.suptitle(self.title, x=0.01, ha='left', fontsize=9.5, wrap=True)
            figure.savefig(figures / f'{self.name}.png', dpi=_PNG_DPI)
        write_csv(self.data, tables / f'{self.name}.csv')

    @property
    def svg(self) -> str:
        """The figure as it stands in the page."""
        # The salt keeps the ids of clip paths apart among the figures of one page.
        salt: dict[Any, Any] = {'svg.hashsalt': self.name}
        buffer = io.StringIO()
        with mpl.rc_context({**RC, **salt}):
            self.draw().savefig(
                buffer, format='svg', metadata={'Date': None, 'Creator': None}, transparent=True
            )
        return _embed(buffer.getvalue())


def _embed(svg: str) -> str:
    """Strip what only a file needs, and let the page set the size and the colours."""
    body = svg[svg.index('<svg') :]
    body = re.sub(r'<metadata>.*?</metadata>', '', body, flags=re.DOTALL)
    body = re.sub(r'(<svg[^>]*?) width="[^"]*"', r'\1', body, count=1)
    body = re.sub(r'(<svg[^>]*?) height="[^"]*"', r'\1', body, count=1)
    body = re.sub(r'<g id="[\w.]*"/>', '', body)
    body = re.sub(r'<g id="[\w.]*">', '<g>', body)
    return _COLOUR.sub(lambda match: _VARIABLES[match.group()], body)
