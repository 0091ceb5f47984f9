# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Figures of the predictions for all sets: the best ones, the ranking, the agreement."""

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hexapod_doe.records.results import Analysis
from hexapod_doe.reporting.figures.chart import Chart
from hexapod_doe.reporting.figures.parts import canvas, design_label, designs, unit_label
from hexapod_doe.reporting.figures.style import (
    BLUE,
    GRID,
    INK,
    MARKERS,
    MUTED,
    SERIES,
    SURFACE,
    WIDE,
)
from hexapod_doe.reporting.formats import count, number
from hexapod_doe.reporting.standing import Standing, all_alike, deciding_parts, standings
from hexapod_doe.reporting.words import Words, words

TOP = 15
"""Sets shown one by one."""
_NAMED = 5
MAX_BARS = 256
"""More intervals than this are drawn as one band."""


def top_sets(analysis: Analysis) -> Chart:
    """Draw the best sets as rows: what they hold, and what they are predicted to earn."""
    ranked = standings(analysis)
    shown = _with_references(ranked)
    factors, named = analysis.design.factors, words(analysis.design)

    def draw() -> Figure:
        figure = Figure(figsize=(WIDE, 0.75 + 0.2 * len(shown)), layout='constrained')
        share = [0.22 * len(factors), WIDE - 0.22 * len(factors)]
        matrix, axes = figure.subplots(1, 2, sharey=True, width_ratios=share)
        _draw_matrix(matrix, shown, factors)
        _draw_intervals(axes, shown)
        matrix.set_yticks(range(len(shown)), [_row_name(p, named) for p in shown])
        axes.set_xlabel(f'predicted {unit_label(analysis)}')
        return figure

    best = ranked[0]
    rivals = sum(_overlap(best, other) for other in ranked[1:])
    level = f'{100 * analysis.level:g} %'
    title = f'{best.label} is predicted best'
    if all_alike(ranked):
        title = 'All sets are predicted alike'
    elif best.ci[0] is not None:
        title += f'; the {level} intervals of {count(rivals, "other set")} overlap its own'
    return Chart(
        'top_sets',
        title,
        f'Thick bars: {level} interval of the mean; thin bars: {level} interval of one new '
        'training. Filled points were trained in this campaign, hollow ones are predictions only.'
        + _basis(analysis),
        _frame(analysis, shown),
        draw,
    )


def ranked_predictions(analysis: Analysis) -> Chart:
    """Draw the predictions of all sets, best first, with their intervals, for every design."""
    level = f'{100 * analysis.level:g} %'
    frames = [_frame(other, standings(other)) for other in designs(analysis)]

    def draw() -> Figure:
        figure, axes = canvas(3.8)
        for index, other in enumerate(designs(analysis)):
            _draw_ranked(axes, standings(other), index, design_label(other.design))
        _name_points(axes, standings(analysis))
        axes.set_xlabel('rank')
        axes.set_ylabel(f'predicted {unit_label(analysis)}')
        axes.set_xlim(0, len(analysis.predictions) + 1)
        if analysis.compared:
            axes.legend(loc='lower left', handlelength=1)
        return figure

    ranked = standings(analysis)
    best, worst = ranked[0], ranked[-1]
    title = f'From {best.label} to {worst.label} the prediction falls by '
    return Chart(
        'ranked_predictions',
        'All sets are predicted alike'
        if all_alike(ranked)
        else title + number(best.value - worst.value),
        f'All {len(analysis.predictions)} sets in the order of their prediction, each design in '
        f'its own order, with the {level} interval of the mean. Filled points were trained.'
        + _basis(analysis),
        pd.concat(frames, ignore_index=True),
        draw,
    )


def agreement(analysis: Analysis) -> Chart | None:
    """Draw the predictions of each compared design against those of the first one."""
    if not analysis.compared:
        return None
    own = {p.label: p.value for p in standings(analysis)}
    data = pd.DataFrame(
        {'label': p.label, 'design': other.design.name, 'x': own[p.label], 'y': p.value}
        for other in analysis.compared
        for p in standings(other)
        if p.label in own
    )
    correlation = float(data['x'].corr(data['y'], method='spearman'))

    def draw() -> Figure:
        figure, axes = canvas(3.8)
        ends = [data[['x', 'y']].min().min(), data[['x', 'y']].max().max()]
        axes.plot(ends, ends, color=MUTED, linewidth=0.8)
        for index, (_, part) in enumerate(data.groupby('design', sort=False), start=1):
            axes.plot(part['x'], part['y'], MARKERS[index], color=SERIES[index], markersize=3.5)
        axes.set_xlabel(f'predicted by the {analysis.design.name}')
        axes.set_ylabel('predicted by the other design')
        return figure

    return Chart(
        'agreement',
        f'The designs order the sets with a rank correlation of {number(correlation, 2)}',
        'Each point is one set; on the line both designs predict the same.',
        data.rename(columns={'x': f'fit_{analysis.design.name}', 'y': 'fit'}),
        draw,
    )


def _basis(analysis: Analysis) -> str:
    if deciding_parts(analysis) is None:
        return ''
    return (
        ' Runs failed, so that the two-part model predicts: its reduced form places the points, '
        'its full form the intervals.'
    )


def _with_references(ranked: Sequence[Standing]) -> list[Standing]:
    """Return the best sets, then the sets of all factors and of none where they are not in."""
    references = (max(ranked, key=lambda s: s.size), min(ranked, key=lambda s: s.size))
    return [*ranked[:TOP], *(s for s in references if s.rank > TOP)]


def _draw_matrix(axes: Axes, shown: Sequence[Standing], factors: Sequence[str]) -> None:
    for row, prediction in enumerate(shown):
        for column, factor in enumerate(factors):
            on = prediction.levels[factor] > 0
            axes.plot(column, row, 'o', color=INK if on else GRID, markersize=5 if on else 3.5)
    axes.set_xticks(range(len(factors)), factors)
    axes.xaxis.tick_top()
    axes.set_xlim(-0.6, len(factors) - 0.4)
    axes.set_ylim(len(shown) - 0.4, -0.6)
    axes.tick_params(labelcolor=INK)
    axes.grid(visible=False)
    axes.spines[:].set_visible(False)


def _draw_intervals(axes: Axes, shown: Sequence[Standing]) -> None:
    for row, p in enumerate(shown):
        for (low, high), width, alpha in ((p.pi, 1.0, 0.55), (p.ci, 3.2, 1.0)):
            if low is not None and high is not None:
                axes.plot((low, high), (row, row), color=BLUE, linewidth=width, alpha=alpha,
                          solid_capstyle='butt')  # fmt: skip
        axes.plot(p.value, row, 'o', color=BLUE, markersize=6, markeredgewidth=1.4,
                  markerfacecolor=BLUE if p.tested else SURFACE, zorder=3)  # fmt: skip
    axes.grid(axis='x')
    axes.grid(visible=False, axis='y')
    axes.tick_params(axis='y', labelleft=False)
    axes.spines['left'].set_visible(False)


def _row_name(standing: Standing, named: Words) -> str:
    whole = standing.size == len(standing.levels)
    name = named.whole if whole else standing.label if standing.size else named.empty
    return f'{name}  {standing.rank}'


def _draw_ranked(axes: Axes, ranked: Sequence[Standing], index: int, label: str) -> None:
    colour, marker = SERIES[index % len(SERIES)], MARKERS[index % len(MARKERS)]
    ranks = np.array([p.rank for p in ranked])
    fits = np.array([p.value for p in ranked])
    bounds = np.array([[np.nan if b is None else b for b in p.ci] for p in ranked])
    tested = np.array([p.tested for p in ranked])
    if len(ranked) > MAX_BARS:
        axes.fill_between(ranks, bounds[:, 0], bounds[:, 1], color=colour, alpha=0.3, linewidth=0)
    else:
        axes.vlines(ranks, bounds[:, 0], bounds[:, 1], color=colour, linewidth=1, alpha=0.45)
    for part, face in ((~tested, SURFACE), (tested, colour)):
        axes.plot(ranks[part], fits[part], marker, color=colour, markerfacecolor=face,
                  markersize=3.2, markeredgewidth=0.8)  # fmt: skip
    axes.plot([], [], marker, color=colour, markersize=4, label=label)


def _name_points(axes: Axes, ranked: Sequence[Standing]) -> None:
    top = ranked[0].ci[1] or ranked[0].value
    names = '  '.join(p.label for p in ranked[:_NAMED])
    axes.annotate(f'best: {names}', (1, top), (0, 5), textcoords='offset points')


def _overlap(best: Standing, other: Standing) -> bool:
    low, high = best.ci[0], other.ci[1]
    return low is not None and high is not None and high >= low


def _frame(analysis: Analysis, predictions: Sequence[Standing]) -> pd.DataFrame:
    return pd.DataFrame(
        {
            'design': analysis.design.name,
            'rank': p.rank,
            'label': p.label,
            'fit': p.value,
            'ci_low': p.ci[0],
            'ci_high': p.ci[1],
            'pi_low': p.pi[0],
            'pi_high': p.pi[1],
            'tested': p.tested,
            'alias_safe': p.alias_safe,
        }
        for p in predictions
    )
