# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Backward elimination that keeps the hierarchy of terms at each step, with its trace."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from statsmodels.regression.linear_model import RegressionResults

from hexapod_doe.designs.terms import CONSTANT, contains, order, sort_key
from hexapod_doe.fitting.blocks import no_blocks
from hexapod_doe.fitting.model import independent_terms, model_matrix, parents
from hexapod_doe.fitting.regression import least_squares

_ROUNDING = 1e-12
"""A coefficient so small against the deviation of the response is none."""


@dataclass(frozen=True)
class Dropped:
    """A term that was dropped, its p-value then, and the model without it."""

    term: str
    p: float
    s: float
    r2: float | None
    r2_adj: float | None


def with_parents(
    levels: pd.DataFrame, terms: Sequence[str], blocks: np.ndarray | None = None
) -> tuple[str, ...]:
    """Add the parents that hierarchy demands, as far as the runs can estimate them too."""
    wanted = set(terms)
    queue = list(terms)
    while queue:
        missing = set(parents(queue.pop())) - wanted
        wanted |= missing
        queue += missing
    added = sorted(wanted - set(terms), key=sort_key)
    return tuple(sorted(independent_terms(levels, [*terms, *added], blocks), key=sort_key))


def eliminate(
    levels: pd.DataFrame,
    response: np.ndarray,
    terms: Sequence[str],
    alpha: float = 0.05,
    hierarchy: bool = True,
    protected: Collection[str] = (),
    blocks: np.ndarray | None = None,
) -> tuple[tuple[str, ...], tuple[Dropped, ...]]:
    """Drop the term of the largest p until none exceeds alpha.

    With hierarchy a term stays while another one that contains it is in the model. Containment
    goes by the named term, so the name given to an alias decides which parents are protected.
    Ties go to the higher order, then to the last in the alphabet.

    Args:
        levels: Coded levels (n rows).
        response: Response (n,).
        terms: Terms of the starting model, which must leave degrees of freedom for error.
        alpha: Significance level.
        hierarchy: Keep parents.
        protected: Terms that are never dropped.
        blocks: Basis of the differences between blocks (n, b), which are never dropped.

    Returns:
        The terms kept and the trace.
    """
    kept, terms = list(terms), list(terms)
    basis = no_blocks(len(levels)) if blocks is None else blocks
    matrix, centred = model_matrix(levels, kept), response - response.mean()

    def fit() -> RegressionResults:
        return least_squares(matrix[:, [terms.index(term) for term in kept]], centred, basis)

    trace: list[Dropped] = []
    result = fit()
    while True:
        free = droppable(kept, hierarchy, protected)
        values = dict(zip(kept, _p_values(result), strict=False))  # those of blocks follow
        if not free or max(values[term] for term in free) <= alpha:
            return tuple(kept), tuple(trace)
        worst = max(free, key=lambda term: (round(values[term], 12), order(term), term))
        kept.remove(worst)
        result = fit()
        trace.append(_dropped(worst, values[worst], result))


def _p_values(result: RegressionResults) -> list[float]:
    """Return the p-values; 1 for a coefficient that is only rounding."""
    model = result.model
    rounding = _ROUNDING * np.sqrt(result.centered_tss / len(model.endog))
    with np.errstate(divide='ignore', invalid='ignore'):
        found = np.nan_to_num(result.pvalues, nan=1.0)
    return [float(p) for p in np.where(np.abs(result.params) <= rounding, 1.0, found)]


def droppable(
    kept: Sequence[str], hierarchy: bool = True, protected: Collection[str] = ()
) -> tuple[str, ...]:
    """Return the terms that may go: not the constant, no protected one, no parent of another."""
    return tuple(
        term
        for term in kept
        if term != CONSTANT
        and term not in protected
        and not (hierarchy and any(contains(other, term) for other in kept))
    )


def _dropped(term: str, p: float, result: RegressionResults) -> Dropped:
    varies = result.centered_tss > 0
    return Dropped(
        term,
        p,
        float(np.sqrt(result.mse_resid)),
        float(result.rsquared) if varies else None,
        float(result.rsquared_adj) if varies else None,
    )
