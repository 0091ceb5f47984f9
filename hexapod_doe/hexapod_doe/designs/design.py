# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Two-level fractional factorial designs 2^(k-p) from generators, in Yates' standard order."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations

import numpy as np

from hexapod_doe.designs.catalogue import catalogue_generators
from hexapod_doe.designs.terms import LETTERS, corners, letters_on, product, sort_key

MIN_FACTORS, MAX_FACTORS = 2, len(LETTERS)
FRACTIONS = {'full': 0, 'half': 1, 'quarter': 2, 'eighth': 3, 'sixteenth': 4}
"""The named fractions: how many factors are generated from the others."""
JOINT = '+'
"""Joins the names of fractions whose cases are run as one design."""


@dataclass(frozen=True)
class Design:
    """A regular two-level design, one row per case.

    The base factors (those without a generator) run through Yates' order, the first one
    changing fastest, as Minitab's StdOrder does.
    """

    name: str
    """What the design is called in files and reports."""
    factors: str
    """The factor letters, one per column."""
    generators: Mapping[str, str]
    """Generated factor -> word of base factors; a leading `-` takes the other fraction."""

    def __post_init__(self) -> None:
        _check_factors(self.factors)
        for factor, word in self.generators.items():
            _check_generator(factor, word, self.factors, self.base)

    @cached_property
    def base(self) -> str:
        """The factors that are set freely."""
        return ''.join(letter for letter in self.factors if letter not in self.generators)

    @cached_property
    def levels(self) -> np.ndarray:
        """The coded levels, -1 and +1. Shape: (cases, factors)."""
        columns = dict(zip(self.base, corners(len(self.base)).T, strict=True))
        for factor, word in self.generators.items():
            sign = -1 if word.startswith('-') else 1
            columns[factor] = sign * np.prod(
                [columns[letter] for letter in word.lstrip('+-')], axis=0
            )
        return np.column_stack([columns[letter] for letter in self.factors])

    @property
    def cases(self) -> int:
        """The number of rows of the design."""
        return len(self.levels)

    @cached_property
    def words(self) -> dict[str, int]:
        """The defining relation without the identity: word -> its sign, shortest first."""
        roots = [
            (product(factor, word.lstrip('+-')), -1 if word.startswith('-') else 1)
            for factor, word in self.generators.items()
        ]
        words = {}
        for size in range(1, len(roots) + 1):
            for group in combinations(roots, size):
                word = product(*(root for root, _ in group))
                words[word] = int(np.prod([sign for _, sign in group]))
        return dict(sorted(words.items(), key=lambda item: sort_key(item[0])))

    def observations(self) -> list[str]:
        """Return the letters that are on in each case, in standard order."""
        return [letters_on(row, self.factors) for row in self.levels]


@dataclass(frozen=True)
class JoinedDesign(Design):
    """The cases of several fractions, each once: they are no regular fraction themselves."""

    parts: tuple[Design, ...]

    @cached_property
    def levels(self) -> np.ndarray:
        """The coded levels, -1 and +1, in the order of the parts. Shape: (cases, factors)."""
        return np.array(
            list(dict.fromkeys(tuple(row) for part in self.parts for row in part.levels))
        )

    @cached_property
    def words(self) -> dict[str, int]:
        """The words that have one sign in all parts."""
        first, *others = (part.words for part in self.parts)
        return {
            word: sign
            for word, sign in first.items()
            if all(each.get(word) == sign for each in others)
        }


def fraction(name: str, factors: str | int = 7) -> Design:
    """Return a named fraction: `full`, `half`, `quarter`, `eighth` or `sixteenth`.

    Names with a plus between them, such as `quarter+eighth`, are run as one design, in which a
    case that they share stands once.

    For seven factors `quarter` is F=ABCD, G=ABDE and `eighth` is E=ABC, F=BCD, G=ACD:
    Minitab's default generators, which the article's case numbers agree with.

    Args:
        name: One of `FRACTIONS`, or several.
        factors: The factor letters, or how many to take from the alphabet.

    Raises:
        ValueError: A name is unknown or given twice, or a fraction leaves no resolution III
            design.
    """
    letters = factor_letters(factors) if isinstance(factors, int) else factors
    if JOINT in name:
        names = name.split(JOINT)
        if len(set(names)) < len(names):
            raise ValueError(f'design {name!r}: expected each fraction once')
        parts = tuple(fraction(each, letters) for each in names)
        return JoinedDesign(name, letters, {}, parts)
    if name not in FRACTIONS:
        raise ValueError(f'design {name!r}: expected one of {", ".join(FRACTIONS)}')
    _check_factors(letters)
    return Design(name, letters, catalogue_generators(letters, FRACTIONS[name]))


def from_generators(text: str, factors: str | int = 7, name: str = '') -> Design:
    """Return the design of generators written as `F=ABCD,G=-ABDE`.

    Raises:
        ValueError: A generator is malformed, or a letter unknown.
    """
    letters = factor_letters(factors) if isinstance(factors, int) else factors
    generators = {}
    for part in filter(None, text.replace(' ', '').split(',')):
        factor, equals, word = part.partition('=')
        if not equals or not word:
            raise ValueError(f'generator {part!r}: expected FACTOR=WORD, such as F=ABCD')
        if factor in generators:
            raise ValueError(f'generator {part!r}: factor {factor!r} has a generator already')
        generators[factor] = word
    label = name or f'2^({len(letters)}-{len(generators)})'
    return Design(label, letters, generators)


def factor_letters(count: int) -> str:
    """Return the first `count` factor letters.

    Raises:
        ValueError: The count is not within 2 to 15.
    """
    if not MIN_FACTORS <= count <= MAX_FACTORS:
        raise ValueError(f'{count} factors: expected {MIN_FACTORS} to {MAX_FACTORS}')
    return LETTERS[:count]


def _check_factors(factors: str) -> None:
    factor_letters(len(factors))
    if len(set(factors)) != len(factors) or not all('A' <= letter <= 'Z' for letter in factors):
        raise ValueError(f'factors {factors!r}: expected different capital letters')


def _check_generator(factor: str, word: str, factors: str, base: str) -> None:
    letters = word[1:] if word[:1] in ('+', '-') else word
    if factor not in factors or len(factor) != 1:
        raise ValueError(f'generator {factor}={word}: unknown factor {factor!r} of {factors}')
    unknown = [letter for letter in letters if letter not in base]
    if unknown:
        raise ValueError(
            f'generator {factor}={word}: {unknown[0]!r} is not a base factor, expected {base}'
        )
    if not letters or len(set(letters)) != len(letters):
        raise ValueError(f'generator {factor}={word}: expected different base factors')
