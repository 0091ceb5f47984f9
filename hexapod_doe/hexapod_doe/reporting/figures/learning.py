# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Figures of the runs themselves: every run's response, and the learning curves of each case."""

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from hexapod_doe.records.results import Analysis
from hexapod_doe.reporting.figures.chart import Chart
from hexapod_doe.reporting.figures.parts import canvas, failed, grid, unit_label
from hexapod_doe.reporting.figures.style import BLUE, INK, MUTED, ORANGE, SURFACE
from hexapod_doe.reporting.formats import count, number
from hexapod_doe.reporting.words import words
from hexapod_doe.tables.table import TERM_PREFIX

MAX_PANELS = 64
"""Learning curves are drawn for at most so many cases, the best ones."""
MAX_NAMES = 64
"""More cases than this are drawn without their names, closer together."""
POINTS = 40
"""Curves are drawn through at most so many episodes, or means of spans of them."""
_FENCE = 1.5
_COLUMNS = 4


def runs_by_case(analysis: Analysis) -> Chart:
    """Draw the response of every run, case by case, the best case first."""
    table = analysis.table.assign(failed=failed(analysis))
    means = table.groupby('label')['response'].mean().sort_values(ascending=False)
    order = list(means.index)
    repeated = len(table) > len(order)

    def draw() -> Figure:
        named = len(order) <= MAX_NAMES
        figure, axes = canvas(0.7 + (0.17 if named else 0.05) * len(order))
        rows = table['label'].map({label: row for row, label in enumerate(order)})
        _dots(axes, table['response'], rows, table['kept'], table['failed'])
        if repeated:
            axes.plot(means, range(len(order)), '|', color=INK, markersize=9, markeredgewidth=1.6)
        axes.set_yticks(range(len(order)) if named else [], order if named else [])
        axes.tick_params(axis='y', labelcolor=INK, labelsize=8.5)
        axes.set_ylim(len(order) - 0.4, -0.6)
        axes.grid(visible=False, axis='y')
        axes.grid(visible=True, axis='x')
        axes.set_xlabel(unit_label(analysis))
        return figure

    return Chart(
        'runs_by_case',
        _runs_title(table, order),
        'One dot per training run'
        + (', the bar marks the mean of the case' if repeated else '')
        + '. Hollow dots were left out of the fit; orange ones count as failed.',
        table[['run_id', 'case', 'replicate', 'label', 'response', 'kept', 'failed']],
        draw,
    )


def learning_curves(analysis: Analysis) -> Chart | None:
    """Draw the moving average return of every run, one panel per case, with the case's mean."""
    if analysis.curves.empty:
        return None
    columns = ['case', 'label', 'run_id', 'replicate', 'episode', 'average']
    curves = analysis.curves[columns]
    best = analysis.table.groupby('case')['response'].mean().nlargest(MAX_PANELS).index
    data = _thinned(curves[curves['case'].isin(best)])
    cases = data.drop_duplicates('case').sort_values('case')[['case', 'label']]

    def draw() -> Figure:
        figure, panels = grid(len(cases), _COLUMNS, 0.72)
        for axes, (case, label) in zip(panels, cases.itertuples(index=False), strict=True):
            _draw_case(axes, data[data['case'] == case])
            axes.set_title(f'{case}  {label}', loc='left', fontsize=8.5, pad=3)
            axes.tick_params(labelbottom=axes in panels[-_COLUMNS:])
        figure.supxlabel('episode', y=0.01, fontsize=9, color=MUTED)
        figure.supylabel('moving average of the return', x=0.01, fontsize=9, color=MUTED)
        return figure

    return Chart(
        'learning_curves',
        _curves_title(curves),
        'Thin lines are training runs, the thick line is the mean of the case; a replicate that '
        'ends beyond 1.5 interquartile ranges of the others is named. All panels share their '
        f'axes. The number is the case, the letters are {words(analysis.design).held}.'
        + (f' The {MAX_PANELS} best cases are shown.' if len(cases) == MAX_PANELS else ''),
        data,
        draw,
    )


def _dots(axes: Axes, x: pd.Series, rows: pd.Series, kept: pd.Series, failed: pd.Series) -> None:
    for bad, colour in ((False, BLUE), (True, ORANGE)):
        for used, face in ((False, SURFACE), (True, colour)):
            part = (failed == bad) & (kept == used)
            axes.plot(x[part], rows[part], 'o', color=colour, markerfacecolor=face,
                      markersize=4, alpha=0.8, markeredgewidth=0.9)  # fmt: skip


def _runs_title(table: pd.DataFrame, order: list[str]) -> str:
    failures = int(table['failed'].sum())
    runs = len(table)
    if failures:
        return f'{failures} of {runs} runs failed'
    if table.groupby('label').size().max() == 1:
        return f'{count(runs, "run")}, one of each case: their spread by chance is unknown'
    within = float(np.sqrt(table.groupby('label')['response'].var(ddof=1).mean()))
    return f'Runs of one case spread by {number(within, 2)} (standard deviation)'


def _thinned(curves: pd.DataFrame) -> pd.DataFrame:
    last = int(curves['episode'].max())
    first = int(curves['episode'].min())
    chosen = np.unique(np.linspace(first, last, POINTS).round().astype(int))
    return curves[curves['episode'].isin(chosen)].sort_values(['case', 'run_id', 'episode'])


def _draw_case(axes: Axes, data: pd.DataFrame) -> None:
    for _, run in data.groupby('run_id'):
        axes.plot(run['episode'], run['average'], color=MUTED, linewidth=0.6, alpha=0.7)
    last = data.sort_values('episode').groupby('replicate').last()
    for replicate in outliers(last['average']):
        axes.annotate(
            f'replicate {replicate}', last.loc[replicate, ['episode', 'average']], (-2, 0),
            textcoords='offset points', ha='right', va='center', fontsize=6.5, color=ORANGE,
        )  # fmt: skip
    mean = data.groupby('episode')['average'].mean()
    style = 'o-' if len(mean) <= 10 else '-'
    axes.plot(mean.index, mean, style, color=BLUE, linewidth=1.7, markersize=3)
    axes.tick_params(labelsize=7.5)
    axes.xaxis.set_major_locator(MaxNLocator(3, integer=True))
    axes.yaxis.set_major_locator(MaxNLocator(3))


def _curves_title(curves: pd.DataFrame) -> str:
    ordered = curves.sort_values('episode').groupby('run_id')['average']
    gain = float((ordered.last() - ordered.first()).median())
    episodes = int(curves.groupby('run_id')['episode'].nunique().max())
    change = 'gains' if gain > 0 else 'loses'
    return f'In {count(episodes, "episode")} the median run {change} {number(abs(gain), 2)}'


def outliers(values: 'pd.Series[float]') -> list[Any]:
    """Return the labels of values beyond 1.5 interquartile ranges of the quartiles (Tukey)."""
    low, high = values.quantile([0.25, 0.75])
    reach = _FENCE * (high - low)
    return list(values.index[(values < low - reach) | (values > high + reach)])


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
