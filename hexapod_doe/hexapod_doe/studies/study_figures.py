# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The figures of a study, in the report's style."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hexapod_doe.records.findings import ConfirmationCheck
from hexapod_doe.records.results import Analysis
from hexapod_doe.reporting.figures.chart import Chart
from hexapod_doe.reporting.figures.learning import learning_curves
from hexapod_doe.reporting.figures.parts import canvas, factor_label, unit_label
from hexapod_doe.reporting.figures.predictions import ranked_predictions
from hexapod_doe.reporting.figures.style import (
    BLUE,
    INK,
    MARKERS,
    MUTED,
    ORANGE,
    SERIES,
    SURFACE,
    WIDE,
)
from hexapod_doe.studies import backtest
from hexapod_doe.studies.study_data import Study, StudyCampaign, effects_of

PREFIX = 'study_'
_COLOURS = (*SERIES, INK, MUTED)
_SHAPES = (*MARKERS, 'v', 'P')


def figures_of(study: Study, tested: pd.DataFrame | None, rule: str) -> list[Chart]:
    """Return the figures that there are runs for, each named for its file.

    Args:
        study: The finished campaigns.
        tested: The backtest of the main campaign, if it is finished.
        rule: Its rule of thumb.
    """
    found: list[Chart | None] = []
    if (main := study.main) is not None:
        found += [
            _named(ranked_predictions(main.whole), 'ranking'),
            _named(effects(main), 'effects'),
            _named(learning_curves(main.whole), 'learning'),
            _named(confirmation(main.whole), 'confirmation'),
        ]
    if tested is not None:
        found.append(_named(backtest.chart(tested, rule), 'backtest'))
    if len(study.tasks) > 1:
        found.append(_named(atlas(study.tasks), 'atlas'))
    return [chart for chart in found if chart is not None]


def _named(chart: Chart | None, name: str) -> Chart | None:
    return None if chart is None else replace(chart, name=f'{PREFIX}{name}')


def effects(campaign: StudyCampaign) -> Chart:
    """Draw the effect of each sensor with its interval, a colour for each fraction."""
    series = dict(campaign.fractions)
    return _effects(
        series,
        f'Effects of the sensors, {" and ".join(series)}',
        'Response with a sensor less that without it, by the model of all terms.',
    )


def atlas(tasks: Mapping[str, StudyCampaign]) -> Chart:
    """Draw the effect of each sensor by task, each in shares of the mean of its task."""
    series = {name: campaign.first[1] for name, campaign in tasks.items()}
    return _effects(
        series,
        'Effects of the sensors by task',
        'In per cent of the mean response of the task, by the model of all terms.',
        share=True,
    )


def _effects(
    series: Mapping[str, Analysis], title: str, caption: str, *, share: bool = False
) -> Chart:
    frames = [_frame(name, analysis, share) for name, analysis in series.items()]
    data = pd.concat(frames, ignore_index=True)
    first = next(iter(series.values()))
    level = f'{100 * first.level:g} %'

    def draw() -> Figure:
        figure, axes = canvas(WIDE, 3.6 + 0.12 * len(series))
        for index, frame in enumerate(frames):
            _draw_effects(axes, frame, index, len(frames))
        factors = list(frames[0]['factor'])
        names = [factor_label(first.design, f, 11) for f in factors]
        axes.set_xticks(range(len(factors)), names)
        axes.tick_params(axis='x', labelcolor=INK)
        axes.axhline(0, color=MUTED, linewidth=0.7)
        axes.set_ylabel('effect, % of the mean' if share else f'effect on {unit_label(first)}')
        figure.legend(*axes.get_legend_handles_labels(), loc='outside lower center', ncols=3)
        return figure

    return Chart('effects', title, f'{caption} Bars are {level} intervals.', data, draw)


def _frame(name: str, analysis: Analysis, share: bool) -> pd.DataFrame:
    frame = pd.DataFrame(effects_of(analysis))
    if share:
        mean = abs(float(analysis.table['response'].mean()))
        frame[['effect', 'low', 'high']] *= 100 / mean
    return frame.assign(series=name)


def _draw_effects(axes: Axes, frame: pd.DataFrame, index: int, count: int) -> None:
    colour, marker = _COLOURS[index % len(_COLOURS)], _SHAPES[index % len(_SHAPES)]
    x = frame.index.to_numpy() + 0.7 * ((index + 0.5) / count - 0.5)
    axes.vlines(x, frame['low'], frame['high'], color=colour, linewidth=2.0, alpha=0.6)
    axes.plot(x, frame['effect'], marker, color=colour, label=str(frame['series'].iloc[0]))


def confirmation(analysis: Analysis) -> Chart | None:
    """Draw the new runs of each set beside the interval that was stated before them."""
    found = analysis.confirmation
    checks = [check for check in found.checks if check.observed] if found else []
    if found is None or not checks:
        return None
    data = pd.DataFrame([row for check in checks for row in _check_rows(check)])
    passed = sum(bool(check.passed) for check in checks)

    def draw() -> Figure:
        figure, axes = canvas(WIDE, 1.0 + 0.34 * len(checks))
        for row, check in enumerate(checks):
            _draw_check(axes, row, check)
        axes.set_yticks(range(len(checks)), [check.label for check in checks])
        axes.invert_yaxis()
        axes.grid(axis='x')
        axes.grid(visible=False, axis='y')
        axes.tick_params(axis='y', labelcolor=INK)
        axes.set_xlabel(unit_label(analysis))
        return figure

    return Chart(
        'confirmation',
        f'{passed} of {len(checks)} sets are confirmed',
        f'Bars: {100 * found.level:g} % interval of the mean of the new runs, stated before them; '
        'dots: the runs; diamonds: their means, filled where they lie within.',
        data,
        draw,
    )


def _check_rows(check: ConfirmationCheck) -> list[dict[str, object]]:
    low, high = check.interval
    return [
        {'set': check.label, 'predicted': check.predicted, 'low': low, 'high': high,
         'observed': value, 'mean': check.observed_mean, 'confirmed': check.passed}
        for value in check.observed
    ]  # fmt: skip


def _draw_check(axes: Axes, row: int, check: ConfirmationCheck) -> None:
    colour = BLUE if check.passed else ORANGE
    low, high = check.interval
    if low is not None and high is not None:
        axes.plot((low, high), (row, row), color=colour, linewidth=5, alpha=0.3,
                  solid_capstyle='butt')  # fmt: skip
    axes.plot(check.observed, [row] * len(check.observed), '.', color=MUTED, markersize=4)
    axes.plot(float(np.mean(check.observed)), row, 'D', color=colour, markersize=6,
              markerfacecolor=colour if check.passed else SURFACE)  # fmt: skip
