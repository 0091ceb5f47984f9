# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What a two-level design cannot tell apart: defining words, resolution and alias sets.

Everything is read off the columns of the design, so that it holds for folded, augmented or
partly run designs as well as for regular fractions.
"""

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from hexapod_doe.designs.design import Design
from hexapod_doe.designs.terms import (
    LETTERS,
    column,
    independent_columns,
    model_matrix,
    normalise,
    sort_key,
    terms_up_to,
)

_BETTER = {(12, 5): 'H=ABCDE,J=ABCDFG,K=BCEF,L=ABEFG,M=BDG'}
"""Generators with fewer short words than Minitab's, where that is not of minimum aberration; found
by exchanging generators from 400 random starts."""


@dataclass(frozen=True)
class AliasSet:
    """Terms whose columns are equal up to sign: the data see only their signed sum."""

    terms: tuple[str, ...]
    """The terms, by order, then alphabetically; the first one represents the set."""
    signs: tuple[int, ...]
    """The sign of each column against the first one's."""

    @property
    def representative(self) -> str:
        """The term that stands for the set in a model."""
        return self.terms[0]

    @property
    def text(self) -> str:
        """The set as it is printed, such as `CE + FG`."""
        return self.text_from(self.representative)

    def text_from(self, term: str) -> str:
        """Return the set as printed when `term` is the one named: its own name comes first."""
        own = self.signs[self.terms.index(term)]
        others = (
            f' {"+" if own * sign > 0 else "-"} {other}'
            for other, sign in zip(self.terms, self.signs, strict=True)
            if other != term
        )
        return term + ''.join(others)


def alias_sets(levels: np.ndarray, factors: str, max_order: int = 2) -> list[AliasSet]:
    """Group all terms up to an order by equal columns, sorted by representative.

    Terms that are confounded with the constant are left out: see `defining_words`.

    Args:
        levels: Coded levels of the cases. Shape: (cases, len(factors)).
        factors: The factor letters.
        max_order: The highest order of the terms that are looked at.
    """
    groups: dict[bytes, list[tuple[str, int]]] = {}
    for term in terms_up_to(factors, max_order):
        values = np.sign(column(levels, factors, term)).astype(np.int8)
        if np.all(values == values[0]):
            continue
        groups.setdefault((values * values[0]).tobytes(), []).append((term, int(values[0])))
    return sorted((_alias_set(group) for group in groups.values()), key=_by_representative)


def alias_text(term: str, levels: np.ndarray, factors: str, max_order: int = 2) -> str:
    """Return the alias string of one term, that term first: `FG + CE` for `FG`.

    Raises:
        ValueError: The term names an unknown factor or is confounded with the constant.
    """
    term = normalise(term, factors)
    reach = max(max_order, len(term))
    for group in alias_sets(levels, factors, reach):
        if term in group.terms:
            kept = [i for i, t in enumerate(group.terms) if len(t) <= max_order or t == term]
            shown = AliasSet(
                tuple(group.terms[i] for i in kept), tuple(group.signs[i] for i in kept)
            )
            return shown.text_from(term)
    raise ValueError(f'term {term!r}: confounded with the constant in this design')


def representatives(levels: np.ndarray, factors: str, max_order: int = 3) -> list[str]:
    """Return one term per alias set: of the lowest order, then first in the alphabet.

    For the two designs of the article and order 3 this is the saturated model, without its
    constant, in Minitab's order.
    """
    return [group.representative for group in alias_sets(levels, factors, max_order)]


def estimable(levels: np.ndarray, factors: str, terms: Sequence[str]) -> list[str]:
    """Return the terms, in order, that raise the rank of the model with a constant.

    In an augmented design alias sets alone don't tell which terms fit together: a column may
    depend on several others without being equal to any.
    """
    basis = np.ones((len(levels), 1)) / np.sqrt(len(levels))
    return [terms[i] for i in independent_columns(model_matrix(levels, factors, terms), basis)]


def rank(levels: np.ndarray, factors: str, terms: Iterable[str]) -> int:
    """Return the rank of a model matrix: how many of its terms the cases can separate."""
    return int(np.linalg.matrix_rank(model_matrix(levels, factors, list(terms))))


def defining_words(levels: np.ndarray, factors: str) -> dict[str, int]:
    """Return the words whose column is constant, with its sign, shortest first."""
    words = {}
    for term in terms_up_to(factors, len(factors)):
        values = column(levels, factors, term)
        if np.all(values == values[0]):
            words[term] = int(values[0])
    return words


def defining_relation(words: dict[str, int]) -> str:
    """Return the defining relation as it is printed, such as `I = CEFG = -ABCDF`."""
    signed = (f'{"-" if sign < 0 else ""}{word}' for word, sign in words.items())
    return ' = '.join(['I', *signed])


def resolution(words: Iterable[str]) -> int | None:
    """Return the length of the shortest defining word; None for a full factorial."""
    return min((len(word) for word in words), default=None)


def word_length_pattern(words: Iterable[str], factors: str) -> dict[str, int]:
    """Return how many defining words have each length from 3: `{'A3': 0, 'A4': 1, ...}`."""
    lengths = [len(word) for word in words]
    return {f'A{size}': lengths.count(size) for size in range(3, len(factors) + 1)}


def clear_interactions(levels: np.ndarray, factors: str) -> list[str]:
    """Return the two-factor interactions that are aliased with no main effect or other one."""
    return [
        group.representative
        for group in alias_sets(levels, factors, 2)
        if group.terms == (group.representative,) and len(group.representative) == 2
    ]


def _alias_set(group: list[tuple[str, int]]) -> AliasSet:
    ordered = sorted(group, key=lambda item: sort_key(item[0]))
    first = ordered[0][1]
    return AliasSet(tuple(term for term, _ in ordered), tuple(sign * first for _, sign in ordered))


def _by_representative(group: AliasSet) -> tuple[bool, int, str]:
    return sort_key(group.representative)


def aberration_note(design: Design) -> str:
    """Return that a design is not of minimum aberration, and a better one; empty if none is known.

    Of two fractions that one has less aberration which has fewer words of the first length in
    which they differ (Fries and Hunter 1980, Technometrics 22, 601-608).
    """
    size = (len(design.factors), len(design.generators))
    if size not in _BETTER:
        return ''
    letters = str.maketrans(dict(zip(LETTERS, design.factors, strict=False)))
    text = _BETTER[size].translate(letters)
    better = Design('', design.factors, dict(part.split('=') for part in text.split(',')))
    own, least = (Counter(map(len, each.words)) for each in (design, better))
    length = next((n for n in range(1, 1 + size[0]) if own[n] != least[n]), 0)
    if own[length] <= least[length]:
        return ''
    return (
        f'Not of minimum aberration: --generators {text} has {least[length]} words of length '
        f'{length} instead of {own[length]}.'
    )
