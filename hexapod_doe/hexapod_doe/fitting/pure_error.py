# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Tests against the pure error of repeated runs: lack of fit, and curvature at centre points.

Montgomery, Design and Analysis of Experiments, 8th ed., sections 6.8 and 10.8.
"""

from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy import stats


@dataclass(frozen=True)
class LackOfFit:
    """Test of the model against the pure error of repeated runs."""

    ss_lack_of_fit: float
    df_lack_of_fit: int
    ss_pure_error: float
    df_pure_error: int
    f: float
    p: float


@dataclass(frozen=True)
class Curvature:
    """Test of the centre points against the mean of the factorial runs, by pure error."""

    difference: float
    """Mean of the factorial runs minus mean of the centre points."""
    ss: float
    df_error: int
    f: float | None
    p: float | None


def lack_of_fit(
    sse: float, response: np.ndarray, case: np.ndarray, parameters: int
) -> LackOfFit | None:
    """Return the lack-of-fit test, or None without repeated runs or without spare case.

    Args:
        sse: Error sum of squares of the model.
        response: Response of the rows (n,).
        case: Number of each row's case, from 0 (n,).
        parameters: Terms of the model.
    """
    count = np.bincount(case)
    df_pure, df_lack = len(response) - len(count), len(count) - parameters
    if df_pure < 1 or df_lack < 1:
        return None
    means = np.bincount(case, weights=response) / count
    pure = float(((response - means[case]) ** 2).sum())
    lack = max(sse - pure, 0.0)
    if pure <= 0:
        return None
    f = (lack / df_lack) / (pure / df_pure)
    return LackOfFit(lack, df_lack, pure, df_pure, f, float(stats.f.sf(f, df_lack, df_pure)))


def curvature(levels: pd.DataFrame, response: np.ndarray) -> Curvature | None:
    """Return the curvature test, or None without centre points.

    SS = (ȳ_F − ȳ_C)²·n_F·n_C/(n_F + n_C) on one degree of freedom against pure error.
    """
    centre = (levels == 0).all(axis=1).to_numpy()
    if not centre.any() or centre.all():
        return None
    case = levels.groupby(list(levels.columns), sort=False).ngroup().to_numpy()
    means = np.bincount(case, weights=response) / np.bincount(case)
    pure = float(((response - means[case]) ** 2).sum())
    df = len(response) - len(means)
    difference = float(response[~centre].mean() - response[centre].mean())
    ss = difference**2 * centre.sum() * (~centre).sum() / len(centre)
    f = ss / (pure / df) if df and pure > 0 else None
    return Curvature(difference, ss, df, f, None if f is None else float(stats.f.sf(f, 1, df)))
