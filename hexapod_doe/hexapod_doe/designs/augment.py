# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""More cases for a design that has been run: foldover, semifold, D-optimal augmentation."""

from collections.abc import Sequence

import numpy as np

from hexapod_doe.designs.aliases import estimable, representatives
from hexapod_doe.designs.terms import (
    CONSTANT,
    column,
    corners,
    model_matrix,
    normalise,
    sort_key,
    terms_up_to,
)

_RIDGE = 1e-6
"""Prior information per term, so that the determinant exists before a model is estimable."""


def foldover(levels: np.ndarray, factors: str, on: str) -> np.ndarray:
    """Return the cases of a foldover: the design again with the signs of some factors changed.

    Args:
        levels: Coded levels of the design. Shape: (cases, factors).
        factors: The letters of the columns.
        on: The factors whose sign changes; all of them for a full foldover.

    Returns:
        The new cases only, in the order of the old ones. Shape: (cases, factors).

    Raises:
        ValueError: `on` is empty or names an unknown factor.
    """
    letters = normalise(on, factors)
    if letters == CONSTANT:
        raise ValueError("foldover on '1': expected at least one factor letter")
    signs = np.array([-1 if factor in letters else 1 for factor in factors])
    return np.asarray(levels) * signs


def semifold(levels: np.ndarray, factors: str, on: str, keep: str) -> np.ndarray:
    """Return half of a foldover: the cases where one factor has the given sign before folding.

    Args:
        levels: Coded levels of the design. Shape: (cases, factors).
        factors: The letters of the columns.
        on: The factors whose sign changes.
        keep: A factor letter and a sign, such as `A+` or `C-`.

    Raises:
        ValueError: `keep` is malformed or a letter unknown.
    """
    if len(keep) != 2 or keep[0] not in factors or keep[1] not in '+-':
        raise ValueError(f'semifold keeps {keep!r}: expected a factor and a sign, such as A+')
    chosen = column(levels, factors, keep[0]) == (1 if keep[1] == '+' else -1)
    return foldover(levels[chosen], factors, on)


def d_optimal(
    levels: np.ndarray,
    factors: str,
    extra: int,
    terms: Sequence[str] | None = None,
    seed: int = 0,
    starts: int = 20,
) -> np.ndarray:
    """Choose the extra cases that raise det(X'X) of a model most.

    Row exchange (Fedorov 1972) from random starts over all 2^k corners. A small ridge stands in
    for what the design does not know yet (DuMouchel and Jones 1994, Technometrics 36, 37-47).

    Args:
        levels: The cases that have been run. Shape: (cases, factors).
        factors: The letters of the columns.
        extra: How many cases to add.
        terms: The model without its constant; all terms to order 2 if None.
        seed: Seed of the random starts.
        starts: How many starts the best result is chosen from.

    Returns:
        The new cases. Shape: (extra, factors).

    Raises:
        ValueError: `extra` is less than one.
    """
    if extra < 1:
        raise ValueError(f'{extra} extra cases: expected at least 1')
    model = [CONSTANT, *(terms_up_to(factors, 2) if terms is None else terms)]
    candidates = corners(len(factors))
    rows = model_matrix(candidates, factors, model)
    fixed = model_matrix(levels, factors, model)
    base = fixed.T @ fixed + _RIDGE * np.eye(len(model))
    rng = np.random.default_rng(seed)
    tries = [
        np.sort(_exchange(base, rows, rng.integers(len(rows), size=extra))) for _ in range(starts)
    ]
    # Rounded, so that the first of several equally good designs is taken on every machine.
    values = [
        round(np.linalg.slogdet(base + rows[chosen].T @ rows[chosen])[1], 6) for chosen in tries
    ]
    return candidates[tries[int(np.argmax(values))]]


def aimed_model(levels: np.ndarray, factors: str, separate: Sequence[str]) -> list[str]:
    """Return the terms up to order 2 that a design estimates, with named aliases beside them.

    It is the model for `d_optimal` when only some of the confounded terms matter.

    Raises:
        ValueError: A term names an unknown factor.
    """
    known = representatives(levels, factors, max_order=2)
    wanted = {normalise(term, factors) for term in separate}
    return sorted({*known, *wanted}, key=sort_key)


def variance_ratios(
    levels: np.ndarray, factors: str, terms: Sequence[str], cases: int
) -> dict[str, float]:
    """Return how much larger each coefficient's variance is than in an orthogonal design.

    Args:
        levels: All cases, added ones included. Shape: (N, factors).
        factors: The letters of the columns.
        terms: The model without its constant.
        cases: The size of the orthogonal design that is compared with, usually the first one.

    Returns:
        Term -> `cases` * diag((X'X)^-1).

    Raises:
        ValueError: The cases don't separate the terms; the message names those in excess.
    """
    model = [CONSTANT, *terms]
    X = model_matrix(levels, factors, model)
    excess = set(terms) - set(estimable(levels, factors, terms))
    if excess:
        raise ValueError(
            f'{len(X)} cases: not enough to estimate {", ".join(sorted(excess, key=sort_key))} '
            'beside the other terms'
        )
    R = np.linalg.qr(X, mode='r')
    inverse = np.linalg.inv(R)
    variances = cases * np.sum(inverse**2, axis=1)  # (X'X)^-1 = R^-1 R^-T
    return dict(zip(terms, variances[1:].tolist(), strict=True))


def _exchange(base: np.ndarray, rows: np.ndarray, chosen: np.ndarray) -> np.ndarray:
    """Swap one case at a time for the best candidate until no swap raises the determinant."""
    chosen = chosen.copy()
    improved = True
    while improved:
        improved = False
        for position in range(len(chosen)):
            others = np.delete(chosen, position)
            information = base + rows[others].T @ rows[others]
            # det(M + xx') = det(M) (1 + x'M^-1 x)
            gains = np.einsum('ij,ij->i', rows, np.linalg.solve(information, rows.T).T)
            winner = int(np.argmax(gains))
            if gains[winner] > gains[chosen[position]] * (1 + 1e-9):
                chosen[position], improved = winner, True
    return chosen
