# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Words over factor letters (`A`, `AB`, `1`): their products, order and model columns."""

from collections.abc import Iterable, Sequence
from itertools import combinations

import numpy as np

CONSTANT = '1'
"""The empty word: the constant of a model and the identity of a defining relation."""

LETTERS = 'ABCDEFGHJKLM'
"""Factor names for 2 to 12 factors; `I` is left out because it names the identity."""


def order(term: str) -> int:
    """Return the number of factors in a term; 0 for the constant."""
    return 0 if term == CONSTANT else len(term)


def sort_key(term: str) -> tuple[int, str]:
    """Return the key that sorts terms by order, then alphabetically."""
    return order(term), term


def normalise(term: str, factors: str) -> str:
    """Return a term with its letters sorted.

    Raises:
        ValueError: The term has a letter twice, or one that is not a factor.
    """
    if term == CONSTANT:
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
    return outer != inner and (inner == CONSTANT or set(inner) < set(outer))


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
        term: A word over these letters, or the constant.

    Returns:
        Shape: (...).

    Raises:
        ValueError: The term names an unknown factor.
    """
    term = normalise(term, factors)
    if term == CONSTANT:
        return np.ones(np.shape(levels)[:-1])
    indices = [factors.index(letter) for letter in term]
    return np.prod(np.asarray(levels, dtype=float)[..., indices], axis=-1)


def model_matrix(levels: np.ndarray, factors: str, terms: Sequence[str]) -> np.ndarray:
    """Return the columns of several terms side by side. Shape: (..., len(terms))."""
    return np.stack([column(levels, factors, term) for term in terms], axis=-1)


def letters_on(row: Iterable[float], factors: str) -> str:
    """Return the factors of one row that are at the high level: its observation set."""
    return ''.join(letter for letter, level in zip(factors, row, strict=True) if level > 0)
