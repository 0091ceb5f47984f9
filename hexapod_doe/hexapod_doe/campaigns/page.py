# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Writes a campaign's progress as one self-contained page beside its plan.

The page asks its reader to load it again every half minute, and requests nothing else.
"""

from __future__ import annotations

import tempfile
from datetime import UTC, datetime
from pathlib import Path

from jinja2 import Environment, PackageLoader, StrictUndefined, select_autoescape

from hexapod_doe.campaigns.curves import limits, scaled, thin
from hexapod_doe.campaigns.progress import OPEN, Progress, State, duration

PAGE_FILE = 'progress.html'
_RELOAD_S = 30
_POINTS = 32
_WIDTH, _HEIGHT = 96, 24


def write_page(progress: Progress, directory: Path) -> Path:
    """Write the page; whoever reads it meanwhile sees the old one or the new one, whole.

    Raises:
        OSError: the disk refuses.
    """
    page = directory / PAGE_FILE
    content = render(progress).encode()
    with tempfile.TemporaryDirectory(dir=directory, prefix='.page') as drafts:
        draft = Path(drafts) / PAGE_FILE
        draft.write_bytes(content)
        draft.replace(page)
    return page


def render(progress: Progress) -> str:
    """Return the page."""
    environment = Environment(
        loader=PackageLoader('hexapod_doe.campaigns'),
        autoescape=select_autoescape(['html', 'jinja']),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    open_runs = progress.having(*OPEN)
    low, high = limits(thin(run.returns, _POINTS) for run in progress.runs.values())
    return environment.get_template('progress.html.jinja').render(
        progress=progress,
        states={state.value: len(progress.having(state)) for state in State},
        points={name: _points(run.returns, low, high) for name, run in progress.runs.items()},
        low=low,
        high=high,
        width=_WIDTH,
        height=_HEIGHT,
        left=duration(progress.seconds_left),
        reload=_RELOAD_S if open_runs else 0,
        written=datetime.now(UTC),
    )


def _points(returns: list[float], low: float, high: float) -> str:
    """Return a learning curve as the points of an SVG polyline, '' where there is none."""
    curve = scaled(thin(returns, _POINTS), low, high)
    step = _WIDTH / max(len(curve) - 1, 1)
    return ' '.join(f'{k * step:.0f},{_HEIGHT * (1.0 - y):.1f}' for k, y in enumerate(curve))
