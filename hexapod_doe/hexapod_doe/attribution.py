# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Which predictions, and which winner, depend on the name given to a confounded effect.

A fitted coefficient belongs to a whole alias set. Naming it after another member gives the same
fit to every run and another prediction wherever the two columns differ.
"""

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd

from hexapod_doe.model import corners, is_curvature, model_matrix
from hexapod_doe.terms import CONSTANT, column, order, terms_up_to

Candidates = Mapping[str, tuple[tuple[str, int], ...]]


def candidates(levels: pd.DataFrame, terms: Sequence[str]) -> Candidates:
    """Return for each ambiguous term its aliases (itself first) and their signs.

    Aliases up to the term's own order, two at least, are considered: an effect of higher order
    is less likely than the one that was named.
    """
    factors = ''.join(levels.columns)
    cases = levels[(levels != 0).all(axis=1)].drop_duplicates().to_numpy(float)
    found = {}
    for term in terms:
        if term == CONSTANT or is_curvature(term, factors):
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
    """Tell for each of the 2^k combinations whether no naming changes its prediction (2^k,)."""
    points = corners(list(levels.columns))
    safe = np.ones(len(points), dtype=bool)
    for aliases in candidates(levels, terms).values():
        names, signs = zip(*aliases, strict=True)
        columns = model_matrix(points, names) * signs
        safe &= (columns == columns[:, :1]).all(axis=1)
    return safe
