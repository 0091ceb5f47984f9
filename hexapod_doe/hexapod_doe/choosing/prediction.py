# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Predictions of all 2^k combinations, in original units, with their intervals."""

from collections.abc import Collection

import numpy as np
import pandas as pd
from scipy import stats

from hexapod_doe.fitting.blocks import BlockTest
from hexapod_doe.fitting.model import corners, labels, model_matrix
from hexapod_doe.fitting.regression import Fit
from hexapod_doe.fitting.transform import Transform
from hexapod_doe.records.results import Interval, Prediction


def half_widths(
    fit: Fit, points: np.ndarray, level: float, new_runs: int | None = None
) -> np.ndarray:
    """Return half widths of the intervals at some points (m, p), on the fitted scale.

    t·s·√q for the mean, t·s·√(q + 1/m) for the mean of m new runs; q = x₀'(X'X)⁻¹x₀. Blocks add
    the variance between them, see `_with_blocks`.

    Args:
        fit: A fit with degrees of freedom for error.
        points: Rows of the model matrix.
        level: Confidence.
        new_runs: m, or None for the mean itself.
    """
    variance = fit.unscaled_variance(points) + (1 / new_runs if new_runs else 0)
    squared = variance * (fit.s or 0) ** 2
    df = np.full_like(squared, fit.df_error)
    if fit.blocks is not None:
        squared, df = _with_blocks(fit, fit.blocks, squared, new_runs)
    return stats.t.ppf((1 + level) / 2, df) * np.sqrt(squared)


def _with_blocks(
    fit: Fit, blocks: BlockTest, squared: np.ndarray, new_runs: int | None
) -> tuple[np.ndarray, np.ndarray]:
    """Add the variance between blocks to squared standard errors; return them with their df.

    σ²_block/B in the mean over B blocks and σ²_block/m in m new runs, each of a block of its own.
    By Satterthwaite, with σ²_block = (MS_block − s²)/runs where that is positive.
    """
    error = (fit.s or 0) ** 2
    between = blocks.variance(error)
    if between == 0:
        return squared, np.full_like(squared, fit.df_error)
    share = 1 / blocks.count + (1 / new_runs if new_runs else 0)
    total = squared + share * between
    from_blocks = share * blocks.mean_square / blocks.runs
    rest = total - from_blocks
    df = total**2 / (from_blocks**2 / blocks.df + rest**2 / fit.df_error)
    return total, df


def back(eta: np.ndarray, transform: Transform | None) -> np.ndarray:
    """Return original units; NaN below the transform's domain."""
    return eta if transform is None else transform.inverse(eta)


def interval(
    eta: np.ndarray, half: np.ndarray | None, transform: Transform | None
) -> list[Interval]:
    """Map end points on the fitted scale to original units; what does not exist is None."""
    if half is None:
        return [(None, None)] * len(eta)
    low, high = back(eta - half, transform), back(eta + half, transform)
    return [(_number(a), _number(b)) for a, b in zip(low, high, strict=True)]


def predict_all(
    fit: Fit,
    factors: Collection[str],
    transform: Transform | None,
    level: float,
    tested: Collection[str],
    safe: np.ndarray,
) -> tuple[Prediction, ...]:
    """Predict every combination of the factors, in Yates order.

    Args:
        fit: The final model.
        factors: Factor letters.
        transform: How the response was transformed before the fit.
        level: Confidence of the intervals.
        tested: Labels of the combinations that were run.
        safe: Whether each combination is independent of alias names (2^k,).
    """
    grid = corners(list(factors))
    points = model_matrix(grid, fit.terms)
    eta = points @ fit.coef
    known = fit.s is not None
    fits = back(eta, transform)
    ci = interval(eta, half_widths(fit, points, level) if known else None, transform)
    pi = interval(eta, half_widths(fit, points, level, new_runs=1) if known else None, transform)
    se = (fit.s or np.nan) * np.sqrt(fit.unscaled_variance(points))
    ranks = rank_descending(fits)
    return tuple(
        Prediction(
            label=label,
            levels=levels,
            fit=float(fits[i]),
            ci=ci[i],
            pi=pi[i],
            se=_number(se[i]),
            rank=int(ranks[i]),
            tested=label in tested,
            alias_safe=bool(safe[i]),
        )
        for i, (label, levels) in enumerate(zip(labels(grid), _levels(grid), strict=True))
    )


def rank_descending(values: np.ndarray) -> np.ndarray:
    """Return ranks, 1 for the largest value; NaN ranks last, ties keep their order (m,)."""
    filled = np.where(np.isnan(values), -np.inf, values)
    ranks = np.empty(len(values), dtype=int)
    ranks[np.argsort(-filled, kind='stable')] = np.arange(1, len(values) + 1)
    return ranks


def _levels(grid: pd.DataFrame) -> list[dict[str, int]]:
    names = [str(name) for name in grid.columns]
    return [dict(zip(names, map(int, row), strict=True)) for row in grid.to_numpy()]


def _number(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None
