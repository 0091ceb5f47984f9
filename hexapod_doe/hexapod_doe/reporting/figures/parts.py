# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What several figures share: empty canvases, the designs of an analysis, factor names."""

import textwrap

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hexapod_doe.records.results import Analysis, DesignSummary
from hexapod_doe.reporting.figures.style import WIDE
from hexapod_doe.reporting.words import factor_text


def canvas(height: float, width: float = WIDE) -> tuple[Figure, Axes]:
    """Return a figure of a size in inches with one set of axes."""
    figure = Figure(figsize=(width, height), layout='constrained')
    return figure, figure.add_subplot()


def grid(
    panels: int,
    columns: int,
    height: float,
    *,
    gap: float = 0.1,
    below: float = 0.3,
    foot: float = 0.52,
) -> tuple[Figure, list[Axes]]:
    """Return a figure of small panels, row by row, that share their vertical axis.

    Lengths are in inches. Margins are fixed: to measure dozens of panels takes seconds.

    Args:
        panels: How many panels there are.
        columns: How many stand side by side.
        height: Height of a panel's axes.
        gap: Space between columns.
        below: Space between rows, for titles and tick labels.
        foot: Space under the last row, for tick labels and an axis label.
    """
    rows = -(-panels // columns)
    left, right, top, bottom = 0.62, 0.08, 0.3, foot
    total = top + bottom + rows * height + (rows - 1) * below
    figure = Figure(figsize=(WIDE, total))
    axes = np.ravel(figure.subplots(rows, columns, sharey=True, squeeze=False))
    each = (WIDE - left - right - (columns - 1) * gap) / columns
    figure.subplots_adjust(
        left=left / WIDE,
        right=1 - right / WIDE,
        top=1 - top / total,
        bottom=bottom / total,
        wspace=gap / each,
        hspace=below / height,
    )
    for spare in axes[panels:]:
        spare.remove()
    return figure, list(axes[:panels])


def designs(analysis: Analysis) -> list[Analysis]:
    """Return the analysis and those it is compared with."""
    return [analysis, *analysis.compared]


def design_label(design: DesignSummary) -> str:
    """Return a design's name and size for a legend."""
    low, high = design.replicates
    runs = f'{low}' if low == high else f'{low}–{high}'
    return f'{design.name}, {design.cases} × {runs} runs'


def factor_label(design: DesignSummary, factor: str, wrap: int = 0) -> str:
    """Return a factor's letter and name; the name broken into lines of `wrap` characters."""
    name = factor_text(design, factor).removeprefix(factor).strip()
    if not name:
        return factor
    return (
        f'{factor}\n{textwrap.fill(name, wrap, break_long_words=False)}'
        if wrap
        else f'{factor} ({name})'
    )


def failed(analysis: Analysis) -> 'pd.Series[bool]':
    """Tell for each run whether it counts as a failed training; none does without a threshold."""
    threshold = -np.inf if analysis.two_part is None else analysis.two_part.threshold
    return analysis.table['response'] < threshold


def unit_label(analysis: Analysis) -> str:
    """Return the axis label of the response: its name, which is in reward units."""
    return analysis.response.replace('_', ' ')
