# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Words over factor letters (`A`, `AB`, `1`): their products, order and model columns."""

from collections.abc import Iterable, Sequence
from itertools import combinations

import numpy as np

CONSTANT = '1'
"""The empty word: the constant of a model and the identity of a defining relation."""

CURVATURE = 'curvature'
"""The indicator of a centre point as a term. It repeats letters, so no product is called so."""

LETTERS = 'ABCDEFGHJKLMNOP'
"""Factor names for 2 to 15 factors; `I` is left out because it names the identity."""

_TOLERANCE = 1e-9
"""What is left of a column, over its length, below which others explain it."""


def letters(term: str) -> str:
    """Return the factors that a term multiplies; none for the constant and for curvature."""
    return '' if term in (CONSTANT, CURVATURE) else term


def order(term: str) -> int:
    """Return the degree of a term: its factors, 0 for the constant, 2 for curvature."""
    return 2 if term == CURVATURE else len(letters(term))


def is_interaction(term: str) -> bool:
    """Tell whether a term is a product of two factors or more."""
    return len(letters(term)) > 1


def sort_key(term: str) -> tuple[bool, int, str]:
    """Return the key that sorts terms by order, then alphabetically, curvature last."""
    return term == CURVATURE, order(term), term


def normalise(term: str, factors: str) -> str:
    """Return a term with its letters sorted.

    Raises:
        ValueError: The term has a letter twice, or one that is not a factor.
    """
    if term in (CONSTANT, CURVATURE):
        return term
    for letter in term:
        if letter not in factors:
            raise ValueError(
                f'term {term!r}: unknown factor {letter!r}, expected one of {factors}'
            )
    if not term or len(set(term)) != len(term):
        raise ValueError(f'term {term!r}: expected different factor letters, or {CONSTANT!r}')
    return ''.join(sorted(term))


def product(*words: str) -> str:
    """Multiply words modulo 2: a letter that occurs an even number of times vanishes.

    `product('ABD', 'BC')` is `'ACD'`; the product of a word with itself is the constant.
    """
    letters: set[str] = set()
    for word in words:
        letters ^= set() if word == CONSTANT else set(word)
    return ''.join(sorted(letters)) or CONSTANT


def contains(outer: str, inner: str) -> bool:
    """Tell whether `inner` is a proper part of `outer`, as hierarchy sees it."""
    if inner in (CONSTANT, CURVATURE):
        return inner == CONSTANT != outer
    return set(inner) < set(letters(outer))


def terms_up_to(factors: str, max_order: int) -> list[str]:
    """Return all terms of order 1 to `max_order`, by order, then alphabetically."""
    letters = sorted(factors)
    return [
        ''.join(group) for size in range(1, max_order + 1) for group in combinations(letters, size)
    ]


def column(levels: np.ndarray, factors: str, term: str) -> np.ndarray:
    """Return the column of one term: the product of its factors' levels.

    Args:
        levels: Coded levels. Shape: (..., len(factors)).
        factors: The letters of the last axis, in its order.
        term: A word over these letters, the constant, or curvature: 1 where a level is 0.

    Returns:
        Shape: (...).

    Raises:
        ValueError: The term names an unknown factor.
    """
    term = normalise(term, factors)
    if term == CONSTANT:
        return np.ones(np.shape(levels)[:-1])
    if term == CURVATURE:
        return (np.asarray(levels) == 0).any(axis=-1).astype(float)
    indices = [factors.index(letter) for letter in term]
    return np.prod(np.asarray(levels, dtype=float)[..., indices], axis=-1)


def corners(factors: int) -> np.ndarray:
    """Return all 2^k corners, the first factor changing fastest (Yates). Shape: (2^k, k)."""
    runs = np.arange(2**factors)
    return np.stack([2 * (runs >> bit & 1) - 1 for bit in range(factors)], axis=-1)


def model_matrix(levels: np.ndarray, factors: str, terms: Sequence[str]) -> np.ndarray:
    """Return the columns of several terms side by side. Shape: (..., len(terms))."""
    return np.stack([column(levels, factors, term) for term in terms], axis=-1)


def independent_columns(columns: np.ndarray, basis: np.ndarray) -> list[int]:
    """Return which columns, taken in order, those before them and a basis don't explain.

    Args:
        columns: The columns (n, p).
        basis: Orthonormal columns that come before all of them (n, b).
    """
    kept = []
    for index, vector in enumerate(columns.T):
        if basis.shape[1] == len(columns):
            break
        rest = vector - basis @ (basis.T @ vector)
        rest -= basis @ (basis.T @ rest)  # a second pass keeps the basis orthogonal
        length = np.linalg.norm(rest)
        if length > _TOLERANCE * max(1.0, float(np.linalg.norm(vector))):
            basis = np.column_stack([basis, rest / length])
            kept.append(index)
    return kept


def letters_on(row: Iterable[float], factors: str) -> str:
    """Return the factors of one row that are at the high level: its observation set."""
    return ''.join(letter for letter, level in zip(factors, row, strict=True) if level > 0)
