# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Fits of thousands of small campaigns over the same cases at once, for the choice alone.

Sums over the runs of a case are all that they need. What is reported of a campaign is fitted by
`fitting`, to which tests hold these.
"""

from collections.abc import Iterable

import numpy as np
import pandas as pd
from scipy import special, stats

from hexapod_doe.designs.terms import CONSTANT, contains, is_interaction, order
from hexapod_doe.fitting.model import corners, model_matrix

_ALPHA = 0.05
_STEPS, _MAX_STEP, _TOLERANCE = 200, 2.0, 1e-9
_TIED = 1e-9


class Terms:
    """Terms of one model over some cases, and how they hang together."""

    def __init__(self, cases: pd.DataFrame, names: tuple[str, ...]) -> None:
        self.names = names
        self.columns = model_matrix(cases, names)
        """Shape: (cases, terms)."""
        self.points = model_matrix(corners([str(name) for name in cases.columns]), names)
        """Of all combinations (2^k, terms)."""
        self.interaction = np.array([is_interaction(name) for name in names])
        self.main = np.array([order(name) == 1 for name in names])
        self._held = np.array([[contains(big, small) for small in names] for big in names])
        preferred = sorted(names, key=lambda name: (order(name), name))
        self._preference = np.array([preferred.index(name) for name in names])
        self._constant = names.index(CONSTANT)

    def mask(self, names: Iterable[str]) -> np.ndarray:
        """Return which terms are among some (terms,)."""
        return np.isin(self.names, list(names))

    def droppable(self, kept: np.ndarray) -> np.ndarray:
        """Return which of the kept terms are no parent of another one (b, terms)."""
        free = kept & ~((kept.astype(int) @ self._held.astype(int)) > 0)
        free[:, self._constant] = False
        return free

    def worst(self, p: np.ndarray, free: np.ndarray) -> np.ndarray:
        """Return the free term of the largest p; ties go as in `elimination.eliminate` (b,)."""
        rounded = np.where(free, np.round(p, 12), -1.0)
        tied = rounded == rounded.max(axis=1, keepdims=True)
        return np.where(tied, self._preference, -1).argmax(axis=1)

    def best(self, values: np.ndarray) -> np.ndarray:
        """Return the first of the best combinations (b,), from values (b, 2^k)."""
        span = np.ptp(values, axis=1, keepdims=True)
        return (values >= values.max(axis=1, keepdims=True) - _TIED * span).argmax(axis=1)


def sums(values: np.ndarray, inside: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return runs and mean of each case (b, cases), and the squares within all cases (b,)."""
    count = inside.sum(axis=2)
    mean = np.where(inside, values, 0).sum(axis=2) / np.maximum(count, 1)
    within = np.where(inside, values - mean[:, :, None], 0) ** 2
    return count, mean, within.sum(axis=(1, 2))


def _inverse(terms: Terms, weight: np.ndarray, kept: np.ndarray) -> np.ndarray:
    """Return (X'WX)⁻¹ of the kept terms, the identity for the others (b, terms, terms)."""
    product = np.einsum('ci,bc,cj->bij', terms.columns, weight, terms.columns, optimize=True)
    product *= kept[:, :, None] & kept[:, None, :]
    product += np.eye(kept.shape[1]) * ~kept[:, :, None]
    return np.linalg.inv(product)


def least_squares(
    terms: Terms, count: np.ndarray, mean: np.ndarray, within: np.ndarray, kept: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return coefficients and p-values (b, terms), and degrees of freedom for error (b,)."""
    inverse = _inverse(terms, count, kept)
    coef = np.einsum('bij,bj->bi', inverse, ((count * mean) @ terms.columns) * kept)
    sse = within + (count * (mean - coef @ terms.columns.T) ** 2).sum(axis=1)
    df = count.sum(axis=1) - kept.sum(axis=1)
    spread = np.sqrt(np.einsum('bii->bi', inverse) * (sse / np.maximum(df, 1))[:, None])
    with np.errstate(divide='ignore', invalid='ignore'):
        p = 2 * stats.t.sf(np.abs(coef) / spread, df[:, None])
    return coef, np.nan_to_num(p, nan=1.0), df


def eliminate(
    terms: Terms,
    count: np.ndarray,
    mean: np.ndarray,
    within: np.ndarray,
    start: np.ndarray,
    protected: np.ndarray,
) -> np.ndarray:
    """Return the coefficients after backward elimination, 0 for what was dropped (b, terms)."""
    kept = start.copy()
    while True:
        coef, p, _ = least_squares(terms, count, mean, within, kept)
        free = terms.droppable(kept) & ~protected
        going = (free & (p > _ALPHA)).any(axis=1)
        if not going.any():
            return np.where(kept, coef, 0.0)
        kept[going, terms.worst(p, free)[going]] = False


def select_failure(
    terms: Terms, failures: np.ndarray, total: np.ndarray, start: np.ndarray
) -> np.ndarray:
    """Return the log-odds of failure after elimination, 0 for what was dropped (b, terms)."""
    kept = start.copy()
    tests = np.maximum(1, (start & terms.interaction).sum(axis=1, keepdims=True))
    coef = np.zeros(kept.shape)
    while True:
        coef, error = firth_stack(terms, failures, total, kept, coef * kept)
        p = 2 * stats.norm.sf(np.abs(coef) / error)
        p = np.where(terms.interaction, np.minimum(1.0, p * tests), p)
        free = terms.droppable(kept)
        going = (free & (p > _ALPHA)).any(axis=1)
        if not going.any():
            return np.where(kept, coef, 0.0)
        kept[going, terms.worst(p, free)[going]] = False


def firth_stack(
    terms: Terms, failures: np.ndarray, total: np.ndarray, kept: np.ndarray, coef: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return log-odds and their standard errors (b, terms), as `fitting.logistic.firth` does.

    Args:
        terms: The terms.
        failures: Of each case (b, cases).
        total: Runs of each case (b, cases).
        kept: Terms in the model (b, terms).
        coef: Where to begin (b, terms).

    Raises:
        RuntimeError: The steps don't converge.
    """
    for _ in range(_STEPS):
        chance = special.expit(coef @ terms.columns.T)
        weight = chance * (1 - chance)
        inverse = _inverse(terms, total * weight, kept)
        spread = np.einsum('ci,bij,cj->bc', terms.columns, inverse * kept[:, None, :],
                           terms.columns, optimize=True)  # fmt: skip
        residual = failures - total * chance + total * weight * spread * (0.5 - chance)
        step = np.einsum('bij,bj->bi', inverse, (residual @ terms.columns) * kept)
        size = np.abs(step).max(axis=1, keepdims=True)
        if size.max() < _TOLERANCE:
            return coef, np.sqrt(np.einsum('bii->bi', inverse))
        coef = coef + step * np.minimum(1.0, _MAX_STEP / np.maximum(size, _MAX_STEP))
    raise RuntimeError(f'logistic regression: no convergence within {_STEPS} steps')
