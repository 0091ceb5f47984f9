# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Learning curves made small: a line of text, or the points of a small drawing."""

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

_BLOCKS = '▁▂▃▄▅▆▇█'
_OUTER_PERCENT = 2.0


def thin(returns: Sequence[float], points: int) -> NDArray[np.float64]:
    """Return the means of at most so many equal stretches of a curve; NaN returns do not count."""
    values = np.asarray(returns, dtype=np.float64)
    values = values[np.isfinite(values)]
    parts = np.array_split(values, min(points, len(values)) or 1)
    return np.array([part.mean() for part in parts if part.size])


def limits(curves: Iterable[NDArray[np.float64]]) -> tuple[float, float]:
    """Return the range that holds nearly all points of some curves, to draw them on one scale.

    The outermost 2 % at either end are left out: one early fall must not flatten all curves.
    """
    points = np.concatenate([*curves, np.empty(0)])
    if not points.size:
        return 0.0, 1.0
    low, high = np.percentile(points, (_OUTER_PERCENT, 100.0 - _OUTER_PERCENT))
    return (float(low), float(high)) if high > low else (float(low) - 0.5, float(low) + 0.5)


def scaled(curve: NDArray[np.float64], low: float, high: float) -> NDArray[np.float64]:
    """Return a curve with `low` at 0 and `high` at 1, clipped to that."""
    return np.asarray(np.clip((curve - low) / (high - low), 0.0, 1.0))


def sparkline(curve: NDArray[np.float64], low: float, high: float) -> str:
    """Return a curve as one block character per point."""
    heights = np.rint(scaled(curve, low, high) * (len(_BLOCKS) - 1)).astype(int)
    return ''.join(_BLOCKS[height] for height in heights)
