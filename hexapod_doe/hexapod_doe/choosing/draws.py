# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Draws of what a fitted model says, from which ranks and purchases get their uncertainty."""

import numpy as np

from hexapod_doe.choosing.prediction import back
from hexapod_doe.designs.terms import CONSTANT
from hexapod_doe.fitting.dispersion import Dispersion, covariance_root
from hexapod_doe.fitting.regression import Fit
from hexapod_doe.fitting.transform import Transform

_CELLS = 2_000_000
_RELATIVE, _STEPS = 1e-10, 64


def draw_count(combinations: int) -> int:
    """Return how many draws fit into memory with some ease: 4000 for 128 combinations."""
    return int(np.clip(_CELLS // combinations, 500, 4000))


def coefficient_draws(
    fit: Fit, draws: int, rng: np.random.Generator, found: Dispersion | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Draw coefficients (draws, p) and deviations of a new run (draws,) of a least-squares fit.

    s·√(df/χ²) scales both, so that a coefficient's draws follow its t distribution. With blocks
    the constant moves by the error of their mean, and a new run is of a new block; the variance
    between blocks is drawn as (MS_block·df/χ² − s²)/runs (Weerahandi, JASA 88, 1993).
    Where the spread was found to differ by factor, the covariance is that of HC3.
    """
    s = np.sqrt(fit.sse / rng.chisquare(fit.df_error, draws))
    normal = rng.standard_normal((draws, len(fit.terms)))
    coef = fit.coef + s[:, None] * (normal @ covariance_root(fit, found).T)
    test = fit.blocks
    if test is None:
        return coef, s
    between = np.maximum(0.0, test.ss / rng.chisquare(test.df, draws) - s**2) / test.runs
    error = np.sqrt(between / test.count) * rng.standard_normal(draws)
    coef[:, fit.terms.index(CONSTANT)] += error
    return coef, np.sqrt(s**2 + between)


def prediction_draws(
    fit: Fit,
    points: np.ndarray,
    transform: Transform | None,
    draws: int,
    rng: np.random.Generator,
    found: Dispersion | None = None,
) -> np.ndarray:
    """Draw the predictions of some points in original units (draws, m)."""
    coef, _ = coefficient_draws(fit, draws, rng, found)
    return back_draws(coef @ points.T, transform)


def back_draws(eta: np.ndarray, transform: Transform | None) -> np.ndarray:
    """Return draws in original units; below the transform's domain its smallest value."""
    values = back(eta, transform)
    return values if transform is None else np.nan_to_num(values, nan=-transform.shift)


def equal_within(values: np.ndarray) -> np.ndarray:
    """Return what values of a row may differ by and be equal but for rounding (draws,).

    The model doesn't tell the sets apart whose values agree so far. What counts is their range,
    not how far from zero they lie.
    """
    span = np.nanmax(values, axis=1) - np.nanmin(values, axis=1)
    step = np.spacing(np.nanmax(np.abs(values), axis=1))
    return np.maximum(_RELATIVE * span, _STEPS * step)


def interval_of(draws: np.ndarray, level: float) -> tuple[np.ndarray, np.ndarray]:
    """Return equal-tailed interval bounds over the first axis."""
    low, high = np.quantile(draws, [(1 - level) / 2, (1 + level) / 2], axis=0)
    return low, high
