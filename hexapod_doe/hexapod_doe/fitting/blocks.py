# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Blocks of runs that share a seed, a day or a machine: their differences, taken out of a fit.

A fit with blocks has a column for each difference between them. By the theorem of Frisch, Waugh
and Lovell its other coefficients and residuals are those of a fit in which the blocks have been
projected out of the response and of every column, which is how it is computed here.

A seed or a day is one of many that might have been: what is said of means and of new runs
carries the variance between blocks, as in a model with random blocks.
"""

from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy import linalg
from statsmodels.regression.linear_model import OLS, RegressionResults


@dataclass(frozen=True)
class BlockTest:
    """Whether blocks differ by more than runs of one block do; f and p None without error."""

    ss: float
    """Error sum of squares that the blocks take up, given the terms of the model."""
    df: int
    f: float | None
    p: float | None
    runs: float
    """Runs of a block, on average."""

    @property
    def count(self) -> int:
        """How many blocks there are."""
        return self.df + 1

    @property
    def mean_square(self) -> float:
        """Mean square between blocks, expected to be σ² + runs·σ²_block."""
        return self.ss / self.df

    def variance(self, error: float) -> float:
        """Return the estimated variance between blocks, given that of the error; never below 0."""
        return max(0.0, self.mean_square - error) / self.runs


def no_blocks(rows: int) -> np.ndarray:
    """Return the basis of runs that are all of one block (n, 0)."""
    return np.empty((rows, 0))


def block_basis(labels: np.ndarray) -> np.ndarray:
    """Return orthonormal columns that span the differences between blocks.

    Blocks are coded to sum to zero, so that the constant is the mean over blocks, each one
    weighing alike.

    Args:
        labels: The block of each run (n,).

    Returns:
        Shape: (n, blocks − 1).
    """
    codes, names = pd.factorize(labels)
    if len(names) < 2:
        return no_blocks(len(codes))
    indicator = np.eye(len(names))[codes]
    return linalg.qr(indicator[:, :-1] - indicator[:, -1:], mode='economic')[0]


def without_blocks(values: np.ndarray, basis: np.ndarray) -> np.ndarray:
    """Return columns (n,) or (n, p) with the differences between blocks projected out."""
    return values - basis @ (basis.T @ values)


def block_test(result: RegressionResults, df: int) -> BlockTest | None:
    """Test the blocks; None where there is only one.

    Args:
        result: The fit, whose last columns are the differences between blocks.
        df: Blocks less one, the number of these columns.
    """
    if not df:
        return None
    model = result.model
    without = OLS(model.endog, model.exog[:, :-df], hasconst=True).fit()
    ss, runs = max(float(without.ssr - result.ssr), 0.0), len(model.endog) / (df + 1)
    if result.df_resid < 1 or result.ssr <= 0:
        return BlockTest(ss, df, None, None, runs)
    f, p, _ = result.compare_f_test(without)
    return BlockTest(ss, df, float(f), float(p), runs)
