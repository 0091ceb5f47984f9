# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What the reward is made of, and how each part of it changes while the agents learn."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from hexapod_doe.records.results import Analysis
from hexapod_doe.reporting.figures.chart import Chart
from hexapod_doe.reporting.figures.parts import grid
from hexapod_doe.reporting.figures.style import BLUE, MUTED
from hexapod_doe.tables.table import TERM_PREFIX

POINTS = 40
"""Curves are means of at most so many spans of episodes."""


def reward_terms(analysis: Analysis) -> Chart | None:
    """Draw the curve of each reward term: every case thin, the mean of all thick."""
    terms = [name for name in analysis.curves.columns if name.startswith(TERM_PREFIX)]
    if not terms:
        return None
    length = max(1, -(-int(analysis.curves['episode'].max() + 1) // POINTS))
    first = analysis.curves['episode'] // length * length
    data = analysis.curves.assign(episode=first).groupby(['case', 'episode'])[terms].mean()

    def draw() -> Figure:
        figure, panels = grid(len(terms), 3, 1.1, gap=0.45)
        for axes, term in zip(panels, terms, strict=True):
            _draw_term(axes, data[term].unstack('case'))
            axes.set_title(term.removeprefix(TERM_PREFIX), loc='left', fontsize=8.5, pad=3)
        figure.supxlabel('episode', y=0.01, fontsize=9, color=MUTED)
        figure.supylabel('sum over an episode', x=0.01, fontsize=9, color=MUTED)
        return figure

    change = data.groupby('episode').mean().iloc[[0, -1]].diff().iloc[-1]
    largest = str(change.abs().idxmax())
    return Chart(
        'reward_terms',
        f'Learning changes {largest.removeprefix(TERM_PREFIX)} most: '
        f'by {change[largest]:+.3g} an episode',
        'Weighted terms of the reward, which add up to the return. Thin lines are cases, the '
        'thick line is the mean of all. Each point is the mean over its span of episodes.',
        data.reset_index(),
        draw,
    )


def _draw_term(axes: Axes, cases: pd.DataFrame) -> None:
    axes.plot(cases.index, cases, color=MUTED, linewidth=0.5, alpha=0.6)
    axes.plot(cases.index, np.nanmean(cases, axis=1), color=BLUE, linewidth=1.7)
    axes.tick_params(labelsize=7.5)
    axes.xaxis.set_major_locator(MaxNLocator(3, integer=True))
    axes.yaxis.set_major_locator(MaxNLocator(3))
