# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What each estimated coefficient holds of the terms that are left out of a model.

With X₁ the columns that the cases can tell apart and X₂ those they cannot, the coefficients of X₁
estimate β₁ + Aβ₂ with A = (X₁'X₁)⁻¹X₁'X₂ (Box and Wilson 1951). In a regular fraction each column
of A has one entry, ±1; in a Plackett–Burman design, or a fraction with lost cases, an interaction
is spread over several terms.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import pandas as pd

from hexapod_doe.designs.terms import CONSTANT, CURVATURE, is_interaction, order, terms_up_to
from hexapod_doe.fitting.model import centre_points, independent_terms, model_matrix

_NONE = 1e-6
"""A smaller weight is rounding."""


@dataclass(frozen=True)
class AliasMatrix:
    """Weights (estimated, omitted) of the omitted terms in the estimated ones."""

    estimated: tuple[str, ...]
    omitted: tuple[str, ...]
    weights: np.ndarray
    arbitrary: bool = False
    """Whether the cases cannot tell which interactions are real, so that few are estimated."""

    @cached_property
    def is_spread(self) -> np.ndarray:
        """Whether each omitted term is spread over several estimated ones, or in part (m,)."""
        sizes = np.abs(self.weights)
        single = (sizes > _NONE).sum(axis=0) <= 1
        return ~single | (np.abs(sizes.max(axis=0, initial=0) - 0.5) < 0.5 - _NONE)

    def partial(self, term: str) -> dict[str, float]:
        """Return what a term holds of others in part, largest first.

        Omitted terms up to its own order, two at least, are considered.
        """
        if term not in self.estimated:
            return {}
        row = self.weights[self.estimated.index(term)]
        reach = max(2, order(term))
        found = {
            other: float(row[i])
            for i, other in enumerate(self.omitted)
            if self.is_spread[i] and abs(row[i]) > _NONE and order(other) <= reach
        }
        return dict(sorted(found.items(), key=lambda item: -round(abs(item[1]), 6)))


def alias_matrix(levels: pd.DataFrame, terms: Sequence[str]) -> AliasMatrix:
    """Return the alias matrix of a model, completed by what else the cases can estimate.

    In a Plackett–Burman design every interaction is confounded with all others in part, so that
    those which come first in the alphabet would take up what the others do. Where more
    interactions are spread over the estimable ones than there are of these, which ones are
    estimated is arbitrary, and the model is completed by the clear ones only.

    Args:
        levels: Coded levels of the runs; centre points don't count.
        terms: Terms of the model, independent of each other.
    """
    cases = levels[~centre_points(levels)].drop_duplicates()
    named = [term for term in terms if term != CURVATURE]
    highest = max([2, *map(order, named)])
    every = [CONSTANT, *terms_up_to(''.join(map(str, levels.columns)), highest)]
    whole = _matrix(cases, independent_terms(cases, list(dict.fromkeys([*named, *every]))), every)
    kept = sum(map(is_interaction, whole.estimated))
    if sum(map(is_interaction, np.array(whole.omitted)[whole.is_spread])) <= kept:
        return whole
    clear = [
        term
        for term in whole.estimated
        if term in named or not (is_interaction(term) and whole.partial(term))
    ]
    return replace(_matrix(cases, clear, every), arbitrary=True)


def _matrix(cases: pd.DataFrame, estimated: Sequence[str], every: Sequence[str]) -> AliasMatrix:
    known = set(estimated)
    omitted = tuple(term for term in every if term not in known)
    columns = model_matrix(cases, [*estimated, *omitted])
    size = len(known)
    weights = np.linalg.lstsq(columns[:, :size], columns[:, size:])[0]
    return AliasMatrix(tuple(estimated), omitted, weights)


def partial_aliases(levels: pd.DataFrame, terms: Sequence[str]) -> Mapping[str, dict[str, float]]:
    """Return for each term of a model what it holds of others in part; only where it does."""
    matrix = alias_matrix(levels, terms)
    found = {term: matrix.partial(term) for term in terms if term not in (CONSTANT, CURVATURE)}
    return {term: others for term, others in found.items() if others}


def without_arbitrary(levels: pd.DataFrame, terms: Sequence[str]) -> tuple[str, ...]:
    """Return a model without interactions that only the alphabet put into it."""
    matrix = alias_matrix(levels, [term for term in terms if not is_interaction(term)])
    if not matrix.arbitrary:
        return tuple(terms)
    return tuple(term for term in terms if not is_interaction(term) or term in matrix.estimated)


def with_partial_aliases(text: str, others: Mapping[str, float]) -> str:
    """Return an alias string with what the term holds in part, such as `A - 0.33·BC`."""
    parts = (f' {"+" if w > 0 else "-"} {abs(w):.2g}·{term}' for term, w in others.items())
    return text + ''.join(parts)


def short_alias(text: str, limit: int = 3) -> str:
    """Return an alias string cut after some terms: `ABD + ACF + AEG + 4 more`."""
    parts = text.split(' ')  # term, sign, term, sign, term ...
    rest = (len(parts) + 1) // 2 - limit
    return text if rest < 2 else f'{" ".join(parts[: 2 * limit - 1])} + {rest} more'
