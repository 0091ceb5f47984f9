# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Logistic regression with Firth's penalty, finite where all or none of a group fail.

D. Firth, "Bias reduction of maximum likelihood estimates", Biometrika 80 (1993).
"""

from dataclasses import dataclass

import numpy as np
from scipy import linalg, special

_STEPS = 100
_MAX_STEP = 2.0
_TOLERANCE = 1e-10


@dataclass(frozen=True)
class LogisticFit:
    """Log-odds per coded unit (p,) and their covariance (p, p)."""

    coef: np.ndarray
    covariance: np.ndarray

    def probability(self, points: np.ndarray) -> np.ndarray:
        """Return the probability at rows of the model matrix (m, p)."""
        return special.expit(points @ self.coef)


def firth(matrix: np.ndarray, outcome: np.ndarray) -> LogisticFit:
    """Fit P(outcome = 1) by Newton steps on Firth's score X'(y − π + h(½ − π)).

    Args:
        matrix: Model matrix (n, p) of full rank.
        outcome: 0 or 1 (n,).

    Raises:
        RuntimeError: The steps don't converge.
    """
    coef = np.zeros(matrix.shape[1])
    for _ in range(_STEPS):
        probability = special.expit(matrix @ coef)
        root = np.sqrt(probability * (1 - probability))
        q, r = linalg.qr(matrix * root[:, None], mode='economic')
        leverage = (q**2).sum(axis=1)
        score = matrix.T @ (outcome - probability + leverage * (0.5 - probability))
        inverse = linalg.solve_triangular(r, np.eye(len(r)))
        step = inverse @ (inverse.T @ score)
        coef = coef + step * min(1.0, _MAX_STEP / max(np.abs(step).max(), 1e-300))
        if np.abs(step).max() < _TOLERANCE:
            return LogisticFit(coef, inverse @ inverse.T)
    raise RuntimeError(f'logistic regression: no convergence within {_STEPS} steps')
