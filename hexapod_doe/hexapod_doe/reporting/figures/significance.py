# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Figures that tell effects from noise: the Pareto chart and the half-normal plot."""

from dataclasses import dataclass

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy import stats

from hexapod_doe.designs.terms import CONSTANT
from hexapod_doe.fitting.alias_matrix import short_alias
from hexapod_doe.records.results import Analysis, Step
from hexapod_doe.reporting.figures.chart import Chart
from hexapod_doe.reporting.figures.parts import canvas
from hexapod_doe.reporting.figures.style import BLUE, INK, MUTED, ORANGE, SURFACE
from hexapod_doe.reporting.formats import count, listing

MAX_BARS = 20
"""The Pareto chart shows the largest effects only; all are in its table."""


@dataclass(frozen=True)
class Sizes:
    """Effects of one model with the limits that noise keeps within."""

    data: pd.DataFrame
    """term, alias, effect, size; largest first."""
    label: str
    limits: tuple[tuple[str, float], ...]
    """What each limit is called, and its value; an effect beyond the last one is active."""

    @property
    def active(self) -> list[str]:
        """Terms beyond the strictest limit."""
        return list(self.data.loc[self.data['size'] > self.limits[-1][1], 'term'])


def sizes(analysis: Analysis) -> Sizes | None:
    """Return the sizes of all effects: t values, or raw effects where there is no error."""
    alpha = float(analysis.options['alpha'])
    if analysis.lenth is not None:
        step, lenth = analysis.steps[0], analysis.lenth
        values = {term: abs(effect) for term, effect in step.effects.items()}
        limits = (('ME', lenth.margin), ('SME', lenth.simultaneous_margin))
        return Sizes(_frame(step, values), '|effect|', limits)
    judged = _fullest_with_error(analysis)
    if judged is None:
        return None
    values = {term: abs(t) for term, t in judged.t.items() if t is not None and term != CONSTANT}
    critical = float(stats.t.isf(alpha / 2, judged.df_error))
    return Sizes(_frame(judged, values), '|t|', ((f'{100 * alpha:g} % limit', critical),))


def pareto(analysis: Analysis) -> Chart | None:
    """Draw all effects as bars, largest first, with the limit that noise keeps within."""
    found = sizes(analysis)
    if found is None:
        return None
    shown = found.data.head(MAX_BARS)

    def draw() -> Figure:
        figure, axes = canvas(0.9 + 0.21 * len(shown))
        colours = np.where(shown['effect'] > 0, BLUE, ORANGE)
        solid = shown['size'] > found.limits[-1][1]
        bars = axes.barh(
            [short_alias(text) for text in shown['alias']],
            shown['size'],
            0.62,
            color=colours,
            edgecolor=colours,
        )
        for bar, filled in zip(bars, solid, strict=True):
            bar.set_alpha(1 if filled else 0.35)
        axes.invert_yaxis()
        axes.margins(y=0.01)
        axes.grid(visible=False)
        axes.tick_params(axis='y', labelcolor=INK)
        for name, value in found.limits:
            axes.axvline(value, color=INK, linewidth=0.9, linestyle=(0, (4, 2)))
            axes.annotate(
                name, (value, 1), (3, -2), ('data', 'axes fraction'), 'offset points', va='bottom'
            )
        axes.set_xlabel(f'{found.label}  (blue raises, orange lowers)')
        return figure

    return Chart('pareto_effects', _title(found), _caption(found, analysis), found.data, draw)


def half_normal(analysis: Analysis) -> Chart | None:
    """Draw the sizes of the effects against half-normal quantiles."""
    found = sizes(analysis)
    if found is None or len(found.data) < 3:
        return None
    data = found.data.iloc[::-1].reset_index(drop=True)
    share = (np.arange(len(data)) + 0.5) / len(data)
    data = data.assign(quantile=stats.norm.ppf(0.5 + share / 2))
    slope = _zahn(data)

    def draw() -> Figure:
        figure, axes = canvas(3.4)
        top = float(data['quantile'].max())
        axes.plot([0, top], [0, slope * top], color=MUTED, linewidth=0.9)
        active = data['term'].isin(found.active)
        _points(axes, data[~active], SURFACE)
        _points(axes, data[active], BLUE)
        _name_clusters(axes, data[active])
        axes.set_xlabel('half-normal quantile')
        axes.set_ylabel(found.label)
        axes.set_ylim(bottom=0)
        axes.set_xlim(left=0)
        return figure

    return Chart(
        'half_normal',
        f'{_title(found)}: they leave the line that noise follows'
        if found.active
        else 'All effects follow the line that noise alone would give',
        'Effects that are only noise lie on a line through the origin (Zahn’s slope, from the '
        'smaller two thirds); filled points are beyond the limit of the bar chart.',
        data,
        draw,
    )


def _points(axes: Axes, data: pd.DataFrame, face: str) -> None:
    axes.plot(
        data['quantile'], data['size'], 'o', color=BLUE, markerfacecolor=face, markersize=4.5
    )


def _name_clusters(axes: Axes, data: pd.DataFrame) -> None:
    """Name points to their left; those of nearly equal size share one label."""
    if data.empty:
        return
    near = 0.05 * data['size'].max()
    cluster = (data['size'].diff() > near).cumsum()
    for _, group in data.groupby(cluster):
        axes.annotate(
            ', '.join(group['term'].iloc[::-1]),
            (group['quantile'].iloc[0], group['size'].mean()),
            (-7, 0), textcoords='offset points', ha='right', va='center',
        )  # fmt: skip


def _frame(step: Step, values: dict[str, float]) -> pd.DataFrame:
    frame = pd.DataFrame(
        {
            'term': list(values),
            'alias': [step.aliases.get(term, term) for term in values],
            'effect': [step.effects[term] for term in values],
            'size': list(values.values()),
        }
    )
    return frame.sort_values('size', ascending=False, ignore_index=True)


def _fullest_with_error(analysis: Analysis) -> Step | None:
    """Return the model with most terms that has an error, the last of its size."""
    usable = [step for step in analysis.steps if step.df_error > 0 and len(step.terms) > 1]
    return max(reversed(usable), key=lambda step: len(step.terms), default=None)


def _zahn(data: pd.DataFrame) -> float:
    """Return the slope through the origin of the first floor(.683 m + .5) points (Zahn 1975)."""
    low = data.iloc[: int(0.683 * len(data) + 0.5)]
    x, y = low['quantile'].to_numpy(float), low['size'].to_numpy(float)
    return float(x @ y / (x @ x))


def _title(found: Sizes) -> str:
    active = found.active
    total = len(found.data)
    if not active:
        return f'None of {count(total, "effect")} stands out from noise'
    stand = 'stands' if len(active) == 1 else 'stand'
    return f'{listing(active, 6)} {stand} out of {total} effects'


def _caption(found: Sizes, analysis: Analysis) -> str:
    shown = min(MAX_BARS, len(found.data))
    text = f'The {shown} largest of {len(found.data)} effects, each named by the terms it sums. '
    if analysis.lenth is not None:
        return text + (
            'Without replicates the limits are Lenth’s margins: ME for one effect, SME for all '
            'effects at once.'
        )
    return text + 'Pale bars stay within the limit of a single t test.'
