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
"""The gap must be at most this high, against the lower of the peaks beside it."""
MAX_SHARE = 0.5
"""More than this share of failures is not a minority that failed."""
MIN_FAILURES = 3
MIN_MIXED = 0.5
"""At least this share of the failures must be in cases that have a success too."""
_GRID = 512
_LEAST_GROUP = 0.1
_LEAST_MIXED = 0.05
"""Two groups have this share of the runs, and of each of them this share in cases of both."""


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
    0.9·min(sd, IQR/1.349)·n^(−1/5); the gap is its deepest local minimum, against the lower of
    the peaks beside it, with a minority below.
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
    found = [
        valley
        for valley in _valleys(response)
        if MIN_FAILURES <= (response < valley).sum() <= MAX_SHARE * len(response)
        and _mixed(response < valley, case) >= MIN_MIXED
    ]
    if not found:
        return None
    rule = (
        f'valley of the kernel density of all runs, at most {MAX_VALLEY:g} of the lower of the '
        f'peaks beside it, below which lie {MAX_SHARE:.0%} of the runs or fewer, and '
        f'{MIN_MIXED:.0%} of these or more in cases that have a success'
    )
    return Threshold(found[0], rule)


def two_groups(response: np.ndarray, case: np.ndarray) -> float | None:
    """Return what parts the runs into two groups that the rule does not call failure and success.

    They are told from a strong effect, which parts whole cases, by cases that have runs of both.
    """
    for valley in _valleys(response):
        low = response < valley
        smaller = min(low.sum(), (~low).sum())
        if smaller >= max(MIN_FAILURES, _LEAST_GROUP * len(low)) and (
            min(_mixed(low, case), _mixed(~low, case)) >= _LEAST_MIXED
        ):
            return valley
    return None


def _mixed(group: np.ndarray, case: np.ndarray) -> float:
    """Return the share of a group of runs that is in cases with runs of the other one."""
    return float(np.isin(case, case[~group])[group].mean())


def _valleys(response: np.ndarray) -> list[float]:
    """Return where the density has valleys deep enough to part two groups, deepest first."""
    spread = min(response.std(ddof=1), stats.iqr(response) / 1.349)
    if len(response) < 2 * MIN_FAILURES or spread <= 0:
        return []
    bandwidth = 0.9 * spread * len(response) ** -0.2
    density = stats.gaussian_kde(response, bandwidth / response.std(ddof=1))
    grid = np.linspace(response.min(), response.max(), _GRID)
    height = density(grid)
    depth = {
        float(grid[i]): height[i] / min(height[:i].max(), height[i + 1 :].max())
        for i in range(1, len(grid) - 1)
        if height[i] <= height[i - 1] and height[i] < height[i + 1]
    }
    deep = [valley for valley in depth if depth[valley] <= MAX_VALLEY]
    return sorted(deep, key=depth.__getitem__)
