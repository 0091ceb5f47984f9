# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Which predictions, and which winner, depend on the name given to a confounded effect.

A fitted coefficient belongs to a whole alias set. Naming it after another member gives the same
fit to every run and another prediction wherever the two columns differ.
"""

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from itertools import product
from math import prod

import numpy as np
import pandas as pd

from hexapod_doe.choosing.prediction import rank_descending
from hexapod_doe.designs.terms import CONSTANT, CURVATURE, column, order, terms_up_to
from hexapod_doe.fitting.alias_matrix import partial_aliases
from hexapod_doe.fitting.model import centre_points, corners, labels, model_matrix
from hexapod_doe.records.findings import Attribution

MAX_EXAMINED = 4096
"""More namings than this are sampled."""
_CELLS = 4_000_000
"""Namings times combinations stay below this, if that leaves 256 namings."""

Candidates = Mapping[str, tuple[tuple[str, int], ...]]


def candidates(levels: pd.DataFrame, terms: Sequence[str]) -> Candidates:
    """Return for each ambiguous term its aliases (itself first) and their signs.

    Aliases up to the term's own order, two at least, are considered: an effect of higher order
    is less likely than the one that was named.
    """
    factors = ''.join(levels.columns)
    cases = levels[~centre_points(levels)].drop_duplicates().to_numpy(float)
    found = {}
    for term in terms:
        if term in (CONSTANT, CURVATURE):
            continue
        own = column(cases, factors, term)
        others = (
            (other, int(own[0] * values[0]))
            for other in terms_up_to(factors, max(2, order(term)))
            if other != term
            and np.array_equal(abs(own @ (values := column(cases, factors, other))), len(cases))
        )
        aliases = ((term, 1), *others)
        if len(aliases) > 1:
            found[term] = aliases
    return found


def alias_safe(levels: pd.DataFrame, terms: Sequence[str]) -> np.ndarray:
    """Tell for each of the 2^k combinations whether no naming changes its prediction (2^k,).

    Where a term holds a part of others no combination is safe: its main effects are in all.
    """
    points = corners(list(levels.columns))
    safe = np.full(len(points), not partial_aliases(levels, terms))
    for aliases in candidates(levels, terms).values():
        names, signs = zip(*aliases, strict=True)
        columns = model_matrix(points, names) * signs
        safe &= (columns == columns[:, :1]).all(axis=1)
    return safe


def attribute(
    levels: pd.DataFrame,
    terms: Sequence[str],
    coef: np.ndarray,
    value: Callable[[np.ndarray], np.ndarray],
    rng: np.random.Generator,
) -> Attribution:
    """Predict all combinations under each naming of the model's ambiguous terms.

    Args:
        levels: Coded levels of the runs.
        terms: Terms of the model (p).
        coef: Their coefficients (p,).
        value: Maps linear predictors (2^k,) to what the combinations are ranked by.
        rng: For a sample of the namings, where there are too many.
    """
    ambiguous = candidates(levels, terms)
    grid = corners(list(levels.columns))
    names = labels(grid)
    clear = [i for i, term in enumerate(terms) if term not in ambiguous]
    base = model_matrix(grid, terms)[:, clear] @ coef[clear]
    parts = [
        coef[terms.index(term)]
        * (model_matrix(grid, [t for t, _ in group]) * [s for _, s in group])
        for term, group in ambiguous.items()
    ]
    limit = int(np.clip(_CELLS // len(grid), 256, MAX_EXAMINED))
    choices = _namings([part.shape[1] for part in parts], limit, rng)
    found = _Extremes(len(grid))
    for choice in choices:
        found.add(value(base + sum(part[:, j] for part, j in zip(parts, choice, strict=True))))
    return Attribution(
        ambiguous={term: tuple(t for t, _ in group) for term, group in ambiguous.items()},
        partial=partial_aliases(levels, terms),
        attributions=prod(part.shape[1] for part in parts),
        examined=len(choices),
        winners={names[i]: count for i, count in found.winners.most_common()},
        rank_range={
            name: (int(a), int(b))
            for name, a, b in zip(names, found.best_rank, found.worst_rank, strict=True)
        },
        fit_range={
            name: (float(a), float(b))
            for name, a, b in zip(names, found.lowest, found.highest, strict=True)
        },
        safe=tuple(
            name for name, safe in zip(names, alias_safe(levels, terms), strict=True) if safe
        ),
    )


class _Extremes:
    """Extremes of fits and ranks over namings, one at a time: all at once are gigabytes."""

    def __init__(self, combinations: int) -> None:
        self.winners: Counter[int] = Counter()
        self.lowest = np.full(combinations, np.inf)
        self.highest = np.full(combinations, -np.inf)
        self.best_rank = np.full(combinations, combinations)
        self.worst_rank = np.zeros(combinations, dtype=int)

    def add(self, fits: np.ndarray) -> None:
        """Take in the fits of one naming (2^k,)."""
        ranks = rank_descending(fits)
        self.winners[int(ranks.argmin())] += 1
        self.lowest = np.minimum(self.lowest, fits)
        self.highest = np.maximum(self.highest, fits)
        self.best_rank = np.minimum(self.best_rank, ranks)
        self.worst_rank = np.maximum(self.worst_rank, ranks)


def _namings(sizes: Sequence[int], limit: int, rng: np.random.Generator) -> np.ndarray:
    """Return the choice of a name for each ambiguous term, one naming a row."""
    total = prod(sizes)
    if total <= limit:
        return np.array(list(product(*map(range, sizes))), dtype=int).reshape(total, len(sizes))
    sample = rng.integers(0, sizes, (limit, len(sizes)))
    sample[0] = 0  # the naming that was fitted
    return sample
