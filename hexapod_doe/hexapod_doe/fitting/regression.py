# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Ordinary least squares on a coded matrix, by QR, with the diagnostics of a designed experiment.

X'X is never formed: after a power transform responses reach 1e6 and their squares 1e13.
Formulas: Montgomery, Design and Analysis of Experiments, 8th ed., sections 6.2–6.8 and 10.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy import linalg, stats

from hexapod_doe.errors import AnalysisError
from hexapod_doe.fitting.blocks import BlockTest, block_test, no_blocks, without_blocks
from hexapod_doe.fitting.model import check_rank, model_matrix
from hexapod_doe.fitting.pure_error import LackOfFit, lack_of_fit

_SATURATED = 1e-9


@dataclass(frozen=True)
class Fit:
    """A least-squares fit; what does not exist (say, s of a saturated fit) is None.

    Arrays follow `terms` (p) or the rows (n). `r_inverse` (p, p) holds R⁻¹ of X = QR, so that
    Cov(b) = s² R⁻¹R⁻ᵀ; differences between blocks are projected out of X before. `press_cases`
    leaves out all runs of a case at once: it is the honest one for combinations that were never
    run.
    """

    terms: tuple[str, ...]
    coef: np.ndarray
    r_inverse: np.ndarray
    fitted: np.ndarray
    residuals: np.ndarray
    leverage: np.ndarray
    sse: float
    sst: float
    press: float | None
    press_cases: float | None
    lack_of_fit: LackOfFit | None
    blocks: BlockTest | None = None

    @property
    def n(self) -> int:
        """Number of rows."""
        return len(self.residuals)

    @property
    def df_error(self) -> int:
        """Degrees of freedom of the error."""
        return self.n - len(self.terms) - (self.blocks.df if self.blocks else 0)

    @property
    def s(self) -> float | None:
        """Residual standard deviation."""
        return float(np.sqrt(self.sse / self.df_error)) if self.df_error else None

    @property
    def se(self) -> np.ndarray | None:
        """Standard errors of the coefficients."""
        return None if self.s is None else self.s * np.sqrt((self.r_inverse**2).sum(axis=1))

    @property
    def t(self) -> np.ndarray | None:
        """Coefficients over their standard errors; infinite where the fit leaves no error."""
        if self.se is None:
            return None
        with np.errstate(divide='ignore', invalid='ignore'):
            return self.coef / self.se

    @property
    def p(self) -> np.ndarray | None:
        """Two-sided p-values of the coefficients."""
        return None if self.t is None else 2 * stats.t.sf(np.abs(self.t), self.df_error)

    @property
    def r2(self) -> float | None:
        """Share of the total sum of squares that the model takes up."""
        return 1 - self.sse / self.sst if self.sst > 0 else None

    @property
    def r2_adj(self) -> float | None:
        """R² adjusted for the number of terms."""
        if not self.df_error or self.sst <= 0:
            return None
        return 1 - (self.sse / self.df_error) / (self.sst / (self.n - 1))

    @property
    def r2_pred(self) -> float | None:
        """Predicted R², leaving out one row at a time."""
        return None if self.press is None or self.sst <= 0 else 1 - self.press / self.sst

    @property
    def r2_pred_cases(self) -> float | None:
        """Predicted R², leaving out one case at a time."""
        return (
            None if self.press_cases is None or self.sst <= 0 else 1 - self.press_cases / self.sst
        )

    def covariance(self) -> np.ndarray:
        """Return Cov(b) (p, p).

        Raises:
            AnalysisError: the fit is saturated.
        """
        if self.s is None:
            raise AnalysisError(
                'a saturated fit has no error to give its coefficients a covariance'
            )
        return self.s**2 * self.r_inverse @ self.r_inverse.T

    def unscaled_variance(self, points: np.ndarray) -> np.ndarray:
        """Return q = x₀'(X'X)⁻¹x₀ for each row x₀ of `points` (m, p)."""
        return ((points @ self.r_inverse) ** 2).sum(axis=1)


def ols(
    levels: pd.DataFrame,
    response: np.ndarray,
    terms: Sequence[str],
    blocks: np.ndarray | None = None,
) -> Fit:
    """Fit a response (n,) on coded levels (n rows) by least squares.

    Args:
        levels: Coded levels of the runs.
        response: Their response (n,).
        terms: Terms of the model.
        blocks: Basis of the differences between blocks (n, b), see `block_basis`.

    Raises:
        AliasedTermsError: the runs cannot tell the terms apart, or from the blocks.
        AnalysisError: there are fewer rows than terms.
    """
    basis = no_blocks(len(levels)) if blocks is None else blocks
    check_rank(levels, terms, basis)
    matrix = model_matrix(levels, terms)
    if len(matrix) < len(terms) + basis.shape[1]:
        raise AnalysisError(f'{len(terms)} terms need as many runs, the table has {len(matrix)}')
    q, r = linalg.qr(without_blocks(matrix, basis), mode='economic')
    r_inverse = linalg.solve_triangular(r, np.eye(len(r)))
    whole = np.column_stack([basis, q])
    fitted = whole @ (whole.T @ response)
    residuals = response - fitted
    leverage = (whole**2).sum(axis=1)
    cases = levels.groupby(list(levels.columns), sort=False).ngroup().to_numpy()
    sse = float(residuals @ residuals)
    return Fit(
        terms=tuple(terms),
        coef=r_inverse @ (q.T @ response),
        r_inverse=r_inverse,
        fitted=fitted,
        residuals=residuals,
        leverage=leverage,
        sse=sse,
        sst=float(((response - response.mean()) ** 2).sum()),
        press=_press(residuals, leverage),
        press_cases=_press_cases(residuals, whole, cases),
        lack_of_fit=lack_of_fit(sse, response, cases, len(terms), basis),
        blocks=_block_test(matrix, response, basis, sse),
    )


def _block_test(
    matrix: np.ndarray, response: np.ndarray, basis: np.ndarray, sse: float
) -> BlockTest | None:
    q = linalg.qr(matrix, mode='economic')[0]
    rest = response - q @ (q.T @ response)
    rows, df = len(matrix), basis.shape[1]
    return block_test(sse, rows - matrix.shape[1] - df, float(rest @ rest), df, rows)


def _press(residuals: np.ndarray, leverage: np.ndarray) -> float | None:
    """Return Σ(eᵢ/(1−hᵢ))², or None where leaving out a row leaves the model inestimable."""
    if (leverage > 1 - _SATURATED).any():
        return None
    return float(((residuals / (1 - leverage)) ** 2).sum())


def _press_cases(residuals: np.ndarray, q: np.ndarray, cases: np.ndarray) -> float | None:
    """Return PRESS leaving out all rows of a case at once.

    The deleted residuals of rows c are (I − H)⁻¹e with their block H = QQ' of the hat matrix.
    """
    total = 0.0
    for number in range(cases.max() + 1):
        rows = np.flatnonzero(cases == number)
        values, vectors = linalg.eigh(q[rows] @ q[rows].T)
        if values[-1] > 1 - _SATURATED:
            return None
        deleted = (vectors.T @ residuals[rows]) / (1 - values)
        total += float(deleted @ deleted)
    return total
