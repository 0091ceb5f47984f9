# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The learning curves of a study, in the article's manner: runs thin, their mean thick."""

from pathlib import Path

import matplotlib as mpl
import pandas as pd
from matplotlib.axes import Axes

from hexapod_doe.reporting.figures.outliers import outliers
from hexapod_doe.reporting.figures.parts import grid
from hexapod_doe.reporting.figures.style import BLUE, INK, MUTED, ORANGE, RC, WIDE

_SMOOTHING = 10
"""Episodes of the moving average: start offsets alone scatter single returns by hundreds."""


def draw(curves: pd.DataFrame, constant: float, path: Path) -> None:
    """Draw a panel for each set of sensors.

    Args:
        curves: Columns observations, seed, episode and episode_return.
        constant: Mean return of the best constant action, drawn as a line.
        path: PNG file to write.
    """
    sets = list(curves['observations'].unique())
    with mpl.rc_context(RC):
        figure, panels = grid(WIDE, len(sets), len(sets), 2.2)
        for axes, name in zip(panels, sets, strict=True):
            _draw_set(axes, curves[curves['observations'] == name])
            axes.axhline(constant, color=ORANGE, linestyle='--', linewidth=1.0)
            axes.set_title('always-on sensors alone' if name == 'none' else f'with {name}')
            axes.set_xlabel('episode')
        panels[0].annotate(
            'best constant action', (1.0, constant), (0, -4), xycoords=('axes fraction', 'data'),
            textcoords='offset points', color=ORANGE, ha='right', va='top', fontsize=8,
        )  # fmt: skip
        panels[0].set_ylabel(f'return, mean of {_SMOOTHING} episodes')
        figure.savefig(path, dpi=160)


def _draw_set(axes: Axes, curves: pd.DataFrame) -> None:
    """Draw the runs of a set, their mean, and the name of a run that ends far from the others."""
    returns = curves.pivot_table(index='episode', columns='seed', values='episode_return')
    smooth = returns.rolling(_SMOOTHING, min_periods=1).mean()
    axes.plot(smooth.index, smooth, color=MUTED, linewidth=0.7, alpha=0.8)
    axes.plot(smooth.index, smooth.mean(axis=1, skipna=False), color=BLUE, linewidth=2.0)
    ends = smooth.ffill().iloc[-1]
    for seed in outliers(ends):
        axes.annotate(
            f'seed {seed}', (smooth.index[-1], ends[seed]), (-3, 0), textcoords='offset points',
            ha='right', va='center', fontsize=8, color=INK,
        )  # fmt: skip
