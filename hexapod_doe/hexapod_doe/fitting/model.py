# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The coded model matrix of a table of runs, and which terms the runs can tell apart.

Columns are built here and not by a formula language, which would hide a factor named ``C`` and
split aliased columns without a word. Levels are a data frame with one column per factor: −1 or
+1, and at a centre point 0 for every numeric factor, while switches stay at −1 or +1.
"""

from collections.abc import Iterable, Sequence

import numpy as np
import pandas as pd

from hexapod_doe.designs import terms as words
from hexapod_doe.designs.aliases import alias_text
from hexapod_doe.designs.terms import (
    CONSTANT,
    CURVATURE,
    independent_columns,
    is_interaction,
    letters_on,
    normalise,
    order,
    sort_key,
    terms_up_to,
)
from hexapod_doe.errors import AnalysisError
from hexapod_doe.fitting.blocks import no_blocks

EMPTY_SET = '(none)'
CENTRE = 'centre'


class AliasedTermsError(AnalysisError):
    """Terms of one model whose columns the runs cannot tell apart."""


def centre_points(levels: pd.DataFrame) -> np.ndarray:
    """Tell which rows are centre points: those with a factor at 0 (n,)."""
    return levels.eq(0).any(axis=1).to_numpy()


def parse_terms(text: str, factors: Sequence[str]) -> tuple[str, ...]:
    """Read a list such as ``A,B,AB`` into terms; the constant is added.

    Raises:
        AnalysisError: A letter is not a factor or occurs twice in a term, or no term is named.
    """
    parts = [part.strip().replace('*', '') for part in text.split(',') if part.strip()]
    if not parts:
        raise AnalysisError(f'terms {text!r}: no term named, expected a list such as A,B,AB')
    letters = ''.join(factors)
    try:
        terms = {normalise(part, letters) for part in parts}
    except ValueError as error:
        raise AnalysisError(str(error)) from error
    return tuple(sorted(terms | {CONSTANT}, key=sort_key))


def parents(term: str) -> tuple[str, ...]:
    """Return the terms that hierarchy demands with `term`: all its factors but one, each way."""
    if not is_interaction(term):
        return ()
    return tuple(term.replace(letter, '') for letter in term)


def model_matrix(levels: pd.DataFrame, terms: Iterable[str]) -> np.ndarray:
    """Return the coded columns of the terms. Shape: (rows, terms)."""
    return words.model_matrix(levels.to_numpy(float), ''.join(levels.columns), tuple(terms))


def corners(factors: Sequence[str]) -> pd.DataFrame:
    """Return all 2^k combinations in Yates order: the first factor changes fastest."""
    return pd.DataFrame(words.corners(len(factors)), columns=list(factors))


def labels(levels: pd.DataFrame) -> list[str]:
    """Name each row by its factors at +1, such as ``ABCDE``; ``(none)`` where none is.

    Centre points are called ``centre``, and ``centre D`` with the switch D at +1.
    """
    factors = ''.join(levels.columns)
    return [
        f'{CENTRE} {letters_on(row, factors)}'.strip()
        if (row == 0).any()
        else letters_on(row, factors) or EMPTY_SET
        for row in levels.to_numpy(float)
    ]


def independent_terms(
    levels: pd.DataFrame, terms: Sequence[str], blocks: np.ndarray | None = None
) -> tuple[str, ...]:
    """Return the terms, taken in order, whose columns the ones before them don't explain.

    Args:
        levels: Coded levels of the runs (n rows).
        terms: Terms to try.
        blocks: Basis of the differences between blocks (n, b), which come before every term.
    """
    if blocks is None or blocks.shape[1] == 0:
        levels = levels.drop_duplicates()  # runs of one case say nothing new
        blocks = no_blocks(len(levels))
    return tuple(terms[i] for i in independent_columns(model_matrix(levels, terms), blocks))


def explain_dependent(levels: pd.DataFrame, terms: Sequence[str]) -> dict[str, tuple[str, ...]]:
    """Return for each dependent term the independent ones that its column is made of."""
    cases = levels.drop_duplicates()
    kept = independent_terms(levels, terms)
    others = [term for term in terms if term not in kept]
    if not others:
        return {}
    weights = np.linalg.lstsq(model_matrix(cases, kept), model_matrix(cases, others))[0]
    return {
        term: tuple(name for name, weight in zip(kept, column, strict=True) if abs(weight) > 1e-6)
        for term, column in zip(others, weights.T, strict=True)
    }


def check_rank(
    levels: pd.DataFrame, terms: Sequence[str], blocks: np.ndarray | None = None
) -> None:
    """Refuse a model whose columns are dependent.

    Raises:
        AliasedTermsError: Naming each aliased term and the terms that it cannot be told from.
    """
    explained = explain_dependent(levels, terms)
    if explained:
        pairs = '; '.join(f'{term} with {" + ".join(by)}' for term, by in explained.items())
        raise AliasedTermsError(
            f'the runs cannot tell these terms apart: {pairs}; '
            f'{len(terms)} terms have rank {len(terms) - len(explained)}: name one of each'
        )
    free = independent_terms(levels, terms, blocks)
    hidden = [term for term in terms if term not in free]
    if hidden:
        raise AliasedTermsError(
            f'the runs cannot tell {", ".join(hidden)} from the differences between blocks: '
            'leave them out'
        )


def estimable_terms(
    levels: pd.DataFrame, max_order: int | None = None, blocks: np.ndarray | None = None
) -> tuple[str, ...]:
    """Return the representatives that the runs can estimate: lowest order, then alphabet.

    With every order allowed this is the saturated model of the distinct cases. Curvature is
    added when there are centre points. Terms that blocks hide are left out.
    """
    factors = ''.join(levels.columns)
    wanted = [CONSTANT, *terms_up_to(factors, min(max_order or len(factors), len(factors)))]
    if centre_points(levels).any():
        wanted.insert(1, CURVATURE)
    return tuple(sorted(independent_terms(levels, wanted, blocks), key=sort_key))


def alias_strings(levels: pd.DataFrame, terms: Iterable[str]) -> dict[str, str]:
    """Return each term's alias string, itself first, such as ``CE + FG``.

    Aliases up to the term's own order (two at least) are shown; centre points don't count.
    """
    factors = ''.join(levels.columns)
    cases = levels[~centre_points(levels)].drop_duplicates().to_numpy(float)
    return {
        term: term
        if term in (CONSTANT, CURVATURE)
        else alias_text(term, cases, factors, max(2, order(term)))
        for term in terms
    }
