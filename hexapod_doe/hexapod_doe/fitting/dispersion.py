# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Whether runs scatter more with a factor than without it, and fits that allow for it.

The test compares |residual|/√(1 − leverage) between the levels of each factor by Welch's t, after
Levene, with Holm's correction. Where it finds a factor, covariances are MacKinnon and White's HC3
and the deviation of a new run follows a log-linear model (a gamma regression of the squared
residuals), both by statsmodels.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy import stats
from statsmodels.genmod import families
from statsmodels.genmod.generalized_linear_model import GLM
from statsmodels.stats.multitest import multipletests

from hexapod_doe.designs.terms import CONSTANT
from hexapod_doe.fitting.model import model_matrix
from hexapod_doe.fitting.regression import Fit

_ROUNDING = 1e-20
"""Share of the sum of squares that is not spread but the last digits of the numbers."""
_LEAST_DF = 12
"""With fewer degrees of freedom of the error a test of variances sees nothing."""


@dataclass(frozen=True)
class Dispersion:
    """How the spread of the runs differs by factor."""

    ratio: Mapping[str, float]
    """Deviation of a run with each factor over that without it."""
    p: Mapping[str, float]
    """Holm's p-values that the two are equal."""
    active: tuple[str, ...]
    """Factors whose p is below the significance level."""


def dispersion(levels: pd.DataFrame, fit: Fit, alpha: float) -> Dispersion | None:
    """Test the spread of a fit's residuals by factor; None with too few runs to tell.

    Args:
        levels: Coded levels of the rows of the fit.
        fit: A fit without selection, so that what it leaves is not an effect left out.
        alpha: Significance level.
    """
    if fit.df_error < _LEAST_DF or fit.sse <= _ROUNDING * fit.sst:
        return None
    free = 1 - fit.leverage
    size = np.abs(fit.residuals)[free > 1e-9] / np.sqrt(free[free > 1e-9])
    coded = levels[free > 1e-9]
    halves = {
        str(name): (size[coded[name].to_numpy() > 0], size[coded[name].to_numpy() < 0])
        for name in levels.columns
    }
    halves = {name: pair for name, pair in halves.items() if min(map(len, pair)) > 1}
    raw = [float(stats.ttest_ind(*pair, equal_var=False).pvalue) for pair in halves.values()]
    adjusted = multipletests(np.nan_to_num(raw, nan=1.0), method='holm')[1]
    p = dict(zip(halves, map(float, adjusted), strict=True))
    return Dispersion(
        ratio={name: _ratio(*pair) for name, pair in halves.items()},
        p=p,
        active=tuple(name for name, value in p.items() if value < alpha),
    )


def _ratio(high: np.ndarray, low: np.ndarray) -> float:
    low_square = float((low**2).mean())
    return float(np.sqrt((high**2).mean() / low_square)) if low_square > 0 else np.inf


def covariance_root(fit: Fit, found: Dispersion | None) -> np.ndarray:
    """Return a root of Cov(b)/s² (p, p), by HC3 where the spread differs by factor."""
    if found is None or not found.active or (fit.leverage > 1 - 1e-9).any():
        return fit.root
    size = len(fit.terms)
    covariance = np.asarray(fit.result.cov_HC3)[:size, :size]
    try:
        return np.linalg.cholesky(covariance / fit.result.mse_resid)
    except np.linalg.LinAlgError:  # runs without any spread: HC3 is singular
        return fit.root


def relative_deviation(
    grid: pd.DataFrame, levels: pd.DataFrame, fit: Fit, found: Dispersion | None
) -> np.ndarray:
    """Return the deviation of a run at some points over the fit's s (m,).

    Args:
        grid: Coded levels of the points (m rows).
        levels: Coded levels of the rows of the fit.
        fit: The fit.
        found: What the test found.
    """
    if found is None or not found.active:
        return np.ones(len(grid))
    terms = (CONSTANT, *found.active)
    squares = fit.residuals**2 / np.maximum(1 - fit.leverage, 1e-9)
    squares = np.maximum(squares, 1e-6 * squares.mean())  # a gamma variable is positive
    family = families.Gamma(families.links.Log())
    result = GLM(squares / fit.result.mse_resid, model_matrix(levels, terms), family=family).fit()
    return np.sqrt(np.asarray(result.predict(model_matrix(grid, terms))))
