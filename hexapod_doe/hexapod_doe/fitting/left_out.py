# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What interactions add to a prediction that the cases cannot tell apart.

In a Plackett–Burman design the models hold no interaction but clear ones. The others are taken
for random, N(0, τ²), with the τ² that the lack of fit shows; a prediction at x is off by
Σβⱼ·(xⱼ − x'Aⱼ), A the alias matrix.
"""

from dataclasses import dataclass

import numpy as np
import pandas as pd

from hexapod_doe.fitting.alias_matrix import AliasMatrix, alias_matrix
from hexapod_doe.fitting.model import model_matrix
from hexapod_doe.fitting.regression import Fit


@dataclass(frozen=True)
class LeftOut:
    """The interactions that a model leaves out though they may be real."""

    tau_squared: float
    df: int
    """Degrees of freedom of the lack of fit that told τ²."""
    reach: np.ndarray
    """How much of each one is in the prediction of each point, and not in the model (m, j)."""

    @property
    def variance(self) -> np.ndarray:
        """What they add to the variance of each prediction (m,)."""
        return self.tau_squared * (self.reach**2).sum(axis=1)

    def draw(self, draws: int, rng: np.random.Generator) -> np.ndarray:
        """Draw what they add to the predictions (draws, m)."""
        tau = np.sqrt(self.tau_squared * self.df / rng.chisquare(self.df, (draws, 1)))
        return (tau * rng.standard_normal((draws, self.reach.shape[1]))) @ self.reach.T


def left_out(levels: pd.DataFrame, fit: Fit, grid: pd.DataFrame) -> LeftOut | None:
    """Return what a model leaves out; None where the cases tell the interactions apart.

    Args:
        levels: Coded levels of the runs (n rows).
        fit: The model.
        grid: Coded levels of the points that are predicted (m rows).
    """
    matrix, lack = alias_matrix(levels, fit.terms), fit.lack_of_fit
    if not matrix.arbitrary or lack is None:
        return None
    excess = lack.ss_lack_of_fit - lack.df_lack_of_fit * lack.ss_pure_error / lack.df_pure_error
    tau_squared = max(0.0, excess) / float((_not_held(levels, matrix) ** 2).sum())
    return LeftOut(tau_squared, lack.df_lack_of_fit, _not_held(grid, matrix))


def _not_held(levels: pd.DataFrame, matrix: AliasMatrix) -> np.ndarray:
    """Return what of each omitted term's column the estimated ones don't hold (rows, omitted)."""
    held = model_matrix(levels, matrix.estimated) @ matrix.weights
    return model_matrix(levels, matrix.omitted) - held
