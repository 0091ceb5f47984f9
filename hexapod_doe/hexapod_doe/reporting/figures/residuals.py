# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Figures of what a model leaves unexplained, for any step of the analysis."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from scipy import stats

from hexapod_doe.records.results import Analysis, Step
from hexapod_doe.reporting.figures.chart import Chart
from hexapod_doe.reporting.figures.parts import canvas
from hexapod_doe.reporting.figures.style import BLUE, INK, MUTED, NARROW, ORANGE, SURFACE
from hexapod_doe.reporting.formats import count, number, number_fixed, probability

BINS = 20
"""Bins of the histogram, as in the article."""
SIGNIFICANT = 0.05
"""Level of the tests that the titles go by."""
OUTLIER = 3.0
"""A studentised residual beyond this is flagged."""


def histogram(analysis: Analysis, step: Step) -> Chart:
    """Draw the residuals of a step in 20 bins, with the normal curve of the same spread."""
    residuals = np.array(step.residuals)
    counts, edges = np.histogram(residuals, BINS)

    def draw() -> Figure:
        figure, axes = canvas(2.7, NARROW)
        axes.bar(edges[:-1], counts, np.diff(edges), align='edge', color=BLUE, alpha=0.75,
                 edgecolor=SURFACE, linewidth=0.5)  # fmt: skip
        spread = residuals.std()
        if spread > 0:
            x = np.linspace(edges[0], edges[-1], 100)
            scale = len(residuals) * (edges[1] - edges[0])
            axes.plot(x, scale * stats.norm.pdf(x, 0, spread), color=INK, linewidth=1)
        axes.axvline(0, color=MUTED, linewidth=0.8)
        axes.yaxis.set_major_locator(MaxNLocator(integer=True))
        axes.set_xlabel(_residual_label(step))
        axes.set_ylabel('runs')
        return figure

    skew = float(stats.skew(residuals)) if residuals.std() > 0 else 0.0
    side = 'to the left: some runs end far below the rest' if skew < 0 else 'to the right'
    # Under normality the skewness of n values has a standard deviation of about sqrt(6/n).
    leans = abs(skew) > 2 * np.sqrt(6 / len(residuals))
    shape = f'lean {side}' if leans else 'lean to neither side'
    return Chart(
        f'residual_histogram_{step.name}',
        f'Residuals of the {step.name} model {shape} (skewness {number_fixed(skew, 2)})',
        f'{count(step.n, "run")}, {BINS} bins; the curve is a normal one of equal spread.',
        pd.DataFrame({'from': edges[:-1], 'to': edges[1:], 'runs': counts}),
        draw,
        half=True,
    )


def normal_probability(analysis: Analysis, step: Step) -> Chart:
    """Draw the ordered residuals against normal quantiles."""
    data = _rows(analysis, step).sort_values('residual', ignore_index=True)
    share = (np.arange(len(data)) + 0.5) / len(data)
    data = data.assign(quantile=stats.norm.ppf(share))
    spread = data['residual'].std(ddof=0)
    p = float(stats.shapiro(data['residual']).pvalue) if spread > 0 and len(data) > 2 else None

    def draw() -> Figure:
        figure, axes = canvas(2.9, NARROW)
        ends = np.array([data['quantile'].min(), data['quantile'].max()])
        axes.plot(spread * ends, ends, color=MUTED, linewidth=0.9)
        axes.plot(data['residual'], data['quantile'], 'o', color=BLUE, markersize=3, alpha=0.8)
        ticks = [0.001, 0.01, 0.1, 0.5, 0.9, 0.99, 0.999]
        axes.set_yticks(stats.norm.ppf(ticks), [f'{100 * tick:g} %' for tick in ticks])
        axes.set_ylim(min(-2.6, ends[0] - 0.2), max(2.6, ends[1] + 0.2))
        axes.set_xlabel(_residual_label(step))
        axes.set_ylabel('share of runs below')
        return figure

    normal = p is None or p >= SIGNIFICANT
    return Chart(
        f'normal_probability_{step.name}',
        f'Residuals of the {step.name} model '
        + ('could be normal' if normal else 'are not normally distributed'),
        f'Shapiro-Wilk test: p {probability(p)}. On the line they would be normal; a bend at the '
        'lower left is a tail of failed runs.',
        data,
        draw,
        half=True,
    )


def against_fit(analysis: Analysis, step: Step) -> Chart:
    """Draw residuals against fitted values."""
    data = _rows(analysis, step)
    if data['fitted'].nunique() < 2 or data['residual'].abs().max() == 0:
        grows = 'cannot be judged against the fitted value'
    else:
        rank = stats.spearmanr(data['fitted'], data['residual'].abs())
        trend = 'grows' if rank.statistic > 0 else 'shrinks'
        grows = (
            f'{trend if rank.pvalue < SIGNIFICANT else "does not change"} with the fitted value'
        )
    return _scatter(
        f'residuals_vs_fit_{step.name}',
        f'The spread of the runs {grows}',
        'Orange points are beyond three standard deviations of a run left out of the fit.',
        data,
        'fitted',
        'fitted value' + (' (transformed)' if step.scale == 'transformed' else ''),
        _residual_label(step),
    )


def against_order(analysis: Analysis, step: Step) -> Chart:
    """Draw residuals against the order in which the runs were started."""
    data = _rows(analysis, step).sort_values('run_order', ignore_index=True)
    rank = stats.spearmanr(data['run_order'], data['residual'])
    drift = rank.pvalue < SIGNIFICANT
    return _scatter(
        f'residuals_vs_order_{step.name}',
        'Residuals drift with the run order' if drift else 'Residuals do not drift with run order',
        f'Rank correlation {number(rank.statistic, 2)}. A drift would mean that something changed '
        'while the campaign ran.',
        data,
        'run_order',
        'run order',
        _residual_label(step),
    )


def _scatter(
    name: str, title: str, caption: str, data: pd.DataFrame, x: str, x_label: str, y_label: str
) -> Chart:
    def draw() -> Figure:
        figure, axes = canvas(2.7, NARROW)
        axes.axhline(0, color=MUTED, linewidth=0.8)
        for outlier, colour in ((False, BLUE), (True, ORANGE)):
            part = data[data['outlier'] == outlier]
            axes.plot(part[x], part['residual'], 'o', color=colour, markersize=3.2, alpha=0.8)
        for row in data[data['outlier']].nsmallest(3, 'residual').to_dict('records'):
            axes.annotate(
                row['label'], (row[x], row['residual']), (5, 0),
                textcoords='offset points', va='center', fontsize=8,
            )  # fmt: skip
        if x == 'run_order':
            axes.xaxis.set_major_locator(MaxNLocator(integer=True))
        axes.set_xlabel(x_label)
        axes.set_ylabel(y_label)
        return figure

    return Chart(name, title, caption, data, draw, half=True)


def _rows(analysis: Analysis, step: Step) -> pd.DataFrame:
    runs = analysis.table.iloc[list(step.rows)]
    studentised = np.array([np.nan if value is None else value for value in step.studentized])
    return pd.DataFrame(
        {
            'run_id': runs['run_id'].to_numpy(),
            'label': runs['label'].to_numpy(),
            'run_order': runs['run_order'].to_numpy(),
            'fitted': step.fitted,
            'residual': step.residuals,
            'studentized': studentised,
            'outlier': np.abs(studentised) > OUTLIER,
        }
    )


def _residual_label(step: Step) -> str:
    return 'residual (transformed)' if step.scale == 'transformed' else 'residual'
