# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Tests against the pure error of repeated runs: lack of fit, and curvature at centre points.

Montgomery, Design and Analysis of Experiments, 8th ed., sections 6.8 and 10.8.
"""

from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy import linalg, stats


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
    sse: float, response: np.ndarray, case: np.ndarray, parameters: int, blocks: np.ndarray
) -> LackOfFit | None:
    """Return the lack-of-fit test, or None without repeated runs or without spare case.

    Args:
        sse: Error sum of squares of the model.
        response: Response of the rows (n,).
        case: Number of each row's case, from 0 (n,).
        parameters: Terms of the model.
        blocks: Basis of the differences between blocks (n, b); pure error is free of them.
    """
    within = [_within(column, case) for column in (response, *blocks.T)]
    basis = linalg.orth(np.column_stack(within[1:])) if len(within) > 1 else blocks
    rest = within[0] - basis @ (basis.T @ within[0])
    cases = int(case.max()) + 1
    df_pure = len(response) - cases - basis.shape[1]
    df_lack = cases + basis.shape[1] - blocks.shape[1] - parameters
    if df_pure < 1 or df_lack < 1:
        return None
    pure = float(rest @ rest)
    lack = max(sse - pure, 0.0)
    if pure <= 0:
        return None
    f = (lack / df_lack) / (pure / df_pure)
    return LackOfFit(lack, df_lack, pure, df_pure, f, float(stats.f.sf(f, df_lack, df_pure)))


def _within(values: np.ndarray, case: np.ndarray) -> np.ndarray:
    """Return the values less the mean of their case."""
    return values - (np.bincount(case, weights=values) / np.bincount(case))[case]


def curvature(levels: pd.DataFrame, response: np.ndarray) -> Curvature | None:
    """Return the curvature test, or None without centre points.

    SS = (ȳ_F − ȳ_C)²·n_F·n_C/(n_F + n_C) on one degree of freedom against pure error.
    """
    centre = (levels == 0).all(axis=1).to_numpy()
    if not centre.any() or centre.all():
        return None
    case = levels.groupby(list(levels.columns), sort=False).ngroup().to_numpy()
    pure = float((_within(response, case) ** 2).sum())
    df = len(response) - (int(case.max()) + 1)
    difference = float(response[~centre].mean() - response[centre].mean())
    ss = difference**2 * centre.sum() * (~centre).sum() / len(centre)
    f = ss / (pure / df) if df and pure > 0 else None
    return Curvature(difference, ss, df, f, None if f is None else float(stats.f.sf(f, 1, df)))
