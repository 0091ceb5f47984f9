# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Ordinary least squares on a coded matrix: statsmodels' fit with what designed experiments ask.

The response is centred before the fit, so that an offset costs no digits.
Formulas: Montgomery, Design and Analysis of Experiments, 8th ed., sections 6.2–6.8 and 10.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy import linalg, stats
from statsmodels.regression.linear_model import OLS, RegressionResults
from statsmodels.stats.outliers_influence import OLSInfluence

from hexapod_doe.designs.terms import CONSTANT
from hexapod_doe.errors import AnalysisError
from hexapod_doe.fitting.blocks import BlockTest, block_test, no_blocks
from hexapod_doe.fitting.model import check_rank, model_matrix
from hexapod_doe.fitting.pure_error import LackOfFit, lack_of_fit

_SATURATED = 1e-9
_LARGEST = 1e140
_LEAST_STEPS = 1000
"""A response must span so many steps of its floating point numbers."""


@dataclass(frozen=True)
class Fit:
    """A least-squares fit; what does not exist (say, s of a saturated fit) is None.

    Arrays follow `terms` (p) or the rows (n). `result` is the fit of the centred response on the
    columns of the terms, then those of the differences between blocks; `root` (p, p) is a root of
    the terms' part of (X'X)⁻¹, so that Cov(b) = s²·root·rootᵀ. `press_cases` leaves out all runs
    of a case at once: it is the honest one for combinations that were never run.
    """

    terms: tuple[str, ...]
    result: RegressionResults
    coef: np.ndarray
    root: np.ndarray
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
        return float(np.sqrt(self.result.mse_resid)) if self.df_error else None

    @property
    def se(self) -> np.ndarray | None:
        """Standard errors of the coefficients."""
        return self._of_terms(self.result.bse) if self.df_error else None

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
        return float(self.result.rsquared) if self.sst > 0 else None

    @property
    def r2_adj(self) -> float | None:
        """R² adjusted for the number of terms."""
        return float(self.result.rsquared_adj) if self.df_error and self.sst > 0 else None

    @property
    def studentized(self) -> np.ndarray:
        """Externally studentised residuals: eᵢ/(s₍ᵢ₎√(1−hᵢ)), s₍ᵢ₎ without row i; NaN if none."""
        if self.df_error < 2:
            return np.full(self.n, np.nan)
        with np.errstate(divide='ignore', invalid='ignore'):
            internal = OLSInfluence(self.result).resid_studentized_internal
            return internal * np.sqrt((self.df_error - 1) / (self.df_error - internal**2))

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
        return self.s**2 * self.root @ self.root.T

    def unscaled_variance(self, points: np.ndarray) -> np.ndarray:
        """Return q = x₀'(X'X)⁻¹x₀ for each row x₀ of `points` (m, p)."""
        return ((points @ self.root) ** 2).sum(axis=1)

    def _of_terms(self, values: np.ndarray) -> np.ndarray:
        return np.asarray(values)[: len(self.terms)]


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
        AnalysisError: there are fewer rows than terms, or the response has no digits left to fit.
    """
    basis = no_blocks(len(levels)) if blocks is None else blocks
    response = np.asarray(response, float)
    check_rank(levels, terms, basis)
    check_digits(response)
    matrix, size = model_matrix(levels, terms), len(terms)
    if len(matrix) < size + basis.shape[1]:
        raise AnalysisError(f'{size} terms need as many runs, the table has {len(matrix)}')
    centre = float(response.mean()) if CONSTANT in terms else 0.0
    result = least_squares(matrix, response - centre, basis)
    cases = levels.groupby(list(levels.columns), sort=False).ngroup().to_numpy()
    coef = np.array(result.params[:size])
    if CONSTANT in terms:
        coef[list(terms).index(CONSTANT)] += centre
    leverage = OLSInfluence(result).hat_matrix_diag
    _check_explained(result)
    return Fit(
        terms=tuple(terms),
        result=result,
        coef=coef,
        root=np.linalg.cholesky(result.normalized_cov_params[:size, :size]),
        fitted=result.fittedvalues + centre,
        residuals=result.resid,
        leverage=leverage,
        sse=float(result.ssr),
        sst=float(((response - response.mean()) ** 2).sum()),
        press=_press(result.resid, leverage),
        press_cases=_press_cases(result, cases),
        lack_of_fit=lack_of_fit(result, cases, size, basis),
        blocks=block_test(result, basis.shape[1]),
    )


def least_squares(
    matrix: np.ndarray, response: np.ndarray, blocks: np.ndarray
) -> RegressionResults:
    """Return statsmodels' fit of a centred response on a model matrix and blocks (n, b)."""
    return OLS(response, np.column_stack([matrix, blocks]), hasconst=True).fit()


def check_digits(response: np.ndarray) -> None:
    """Refuse a response that differs only in its last digits, or whose squares overflow.

    Raises:
        AnalysisError: Its span is a few steps of its floating point numbers, or no such number.
    """
    with np.errstate(over='ignore'):
        span, step = np.ptp(response), np.spacing(np.abs(response).max())
    if not span < _LARGEST or 0 < span < 1 / _LARGEST:
        raise AnalysisError(
            f'the response spans {span:.2g}, whose square is beyond floating point numbers: give '
            'it in another unit, or choose another transform'
        )
    if 0 < span < _LEAST_STEPS * step:
        raise AnalysisError(
            f'the response differs by {span:.2g} around {response.mean():.6g}, which numbers of '
            '16 digits do not resolve: subtract a constant from it, or choose another transform'
        )


def _check_explained(result: RegressionResults) -> None:
    if result.ssr > result.centered_tss * (1 + 1e-6):
        raise AnalysisError(
            f'the fit explains less than the mean (R² = {result.rsquared:.2g}): the numbers lost '
            'their digits; rescale the response, or choose another transform'
        )


def _press(residuals: np.ndarray, leverage: np.ndarray) -> float | None:
    """Return Σ(eᵢ/(1−hᵢ))², or None where leaving out a row leaves the model inestimable."""
    if (leverage > 1 - _SATURATED).any():
        return None
    return float(((residuals / (1 - leverage)) ** 2).sum())


def _press_cases(result: RegressionResults, cases: np.ndarray) -> float | None:
    """Return PRESS leaving out all rows of a case at once.

    The deleted residuals of rows c are (I − H)⁻¹e with their block H = QQ' of the hat matrix.
    """
    q, residuals, total = linalg.qr(result.model.exog, mode='economic')[0], result.resid, 0.0
    for number in range(cases.max() + 1):
        rows = np.flatnonzero(cases == number)
        values, vectors = linalg.eigh(q[rows] @ q[rows].T)
        if values[-1] > 1 - _SATURATED:
            return None
        deleted = (vectors.T @ residuals[rows]) / (1 - values)
        total += float(deleted @ deleted)
    return total
