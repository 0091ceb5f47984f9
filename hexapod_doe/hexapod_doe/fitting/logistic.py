# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Logistic regression with Firth's penalty, finite where all or none of a group fail.

D. Firth, "Bias reduction of maximum likelihood estimates", Biometrika 80 (1993).
"""

from dataclasses import dataclass

import numpy as np
from scipy import linalg, special, stats

_STEPS = 1000
_HALVINGS = 40
_MAX_STEP = 2.0
_NEAR = 1e-5
_TOLERANCE = 1e-10
_SINGULAR = 1e-13


@dataclass(frozen=True)
class LogisticFit:
    """Log-odds per coded unit (p,) and their covariance (p, p)."""

    coef: np.ndarray
    covariance: np.ndarray

    def probability(self, points: np.ndarray) -> np.ndarray:
        """Return the probability at rows of the model matrix (m, p)."""
        return special.expit(points @ self.coef)


def firth(matrix: np.ndarray, outcome: np.ndarray) -> LogisticFit:
    """Fit P(outcome = 1) by the maximum of the likelihood times the root of the information.

    Newton steps on Firth's score X'(y − π + h(½ − π)) are halved until the penalised likelihood
    rises, so that they converge from anywhere, as in R's logistf and brglm2.

    Args:
        matrix: Model matrix (n, p) of full rank.
        outcome: 0 or 1 (n,).

    Raises:
        RuntimeError: The steps don't converge.
    """
    state = _State.at(matrix, outcome, np.zeros(matrix.shape[1]))
    for _ in range(_STEPS):
        size = float(np.abs(state.step).max())
        if size < _TOLERANCE:
            return LogisticFit(state.coef, state.inverse @ state.inverse.T)
        better = _halved(matrix, outcome, state, min(1.0, _MAX_STEP / size))
        if better is None:
            break
        state = better
    if float(np.abs(state.step).max()) < _NEAR:  # rounding keeps the steps from falling further
        return LogisticFit(state.coef, state.inverse @ state.inverse.T)
    raise RuntimeError(f'logistic regression: no convergence within {_STEPS} steps')


@dataclass(frozen=True)
class _State:
    """Coefficients, and what the penalised likelihood is like there."""

    coef: np.ndarray
    inverse: np.ndarray
    """R⁻¹ of W^½X = QR, so that the information is (R⁻¹R⁻ᵀ)⁻¹."""
    step: np.ndarray
    """Fisher's step: the information's inverse times Firth's score."""
    decrement: float
    """What the step gains, were the likelihood a parabola; 0 at its top."""
    likelihood: float
    """Log-likelihood plus half the log-determinant of the information."""

    @classmethod
    def at(cls, matrix: np.ndarray, outcome: np.ndarray, coef: np.ndarray) -> '_State':
        eta = matrix @ coef
        probability = special.expit(eta)
        root = np.sqrt(probability * special.expit(-eta))
        q, r = linalg.qr(matrix * root[:, None], mode='economic')
        diagonal = np.abs(np.diag(r))
        if diagonal.min() <= _SINGULAR * diagonal.max():
            return cls(coef, r, np.full_like(coef, np.inf), np.inf, -np.inf)
        leverage = (q**2).sum(axis=1)
        score = matrix.T @ (outcome - probability + leverage * (0.5 - probability))
        inverse = np.linalg.inv(r)
        half = inverse.T @ score
        penalised = outcome @ eta - np.logaddexp(0, eta).sum() + np.log(diagonal).sum()
        return cls(coef, inverse, inverse @ half, float(half @ half), float(penalised))


def _halved(matrix: np.ndarray, outcome: np.ndarray, state: _State, share: float) -> _State | None:
    """Return where the first of the halved steps leads that climbs; None if none does.

    Near the top, where the likelihood is flat to its last digit, the gain of the next step tells.
    """
    near = float(np.abs(state.step).max()) < _NEAR
    for _ in range(_HALVINGS):
        found = _State.at(matrix, outcome, state.coef + share * state.step)
        climbs = found.likelihood > state.likelihood and not near
        if climbs or (near and found.decrement < state.decrement):
            return found
        share /= 2
    return None


def lack_of_fit(
    probability: np.ndarray, outcome: np.ndarray, case: np.ndarray, terms: int
) -> float | None:
    """Return the p-value of Pearson's test of a fit against the shares of its cases.

    Args:
        probability: Fitted, of each run (n,).
        outcome: 0 or 1 (n,).
        case: Number of each run's case, from 0 (n,).
        terms: Parameters of the fit.

    Returns:
        None where there are no more cases than terms.
    """
    expected, found = np.bincount(case, probability), np.bincount(case, outcome)
    variance = np.bincount(case, probability * (1 - probability))
    df = len(expected) - terms
    if df < 1:
        return None
    return float(stats.chi2.sf(((found - expected) ** 2 / variance).sum(), df))
