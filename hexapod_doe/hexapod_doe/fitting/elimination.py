# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Backward elimination that keeps the hierarchy of terms at each step, with its trace."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy import linalg, stats

from hexapod_doe.designs.terms import CONSTANT, contains, order, sort_key
from hexapod_doe.fitting.blocks import no_blocks, without_blocks
from hexapod_doe.fitting.model import independent_terms, model_matrix, parents, term_key


@dataclass(frozen=True)
class Dropped:
    """A term that was dropped, its p-value then, and the model without it."""

    term: str
    p: float
    s: float
    r2: float | None
    r2_adj: float | None


@dataclass(frozen=True)
class _Reduced:
    """A least-squares problem rotated onto the columns of its largest model."""

    r: np.ndarray
    rotated: np.ndarray
    outside: float
    """Sum of squares that no term of the largest model takes up."""
    rows: int
    absorbed: int
    """Degrees of freedom that the blocks take."""
    sst: float

    def df_error(self, parameters: int) -> int:
        """Return the degrees of freedom that a number of terms leaves."""
        return self.rows - self.absorbed - parameters

    def sse_and_p(self, columns: list[int]) -> tuple[float, np.ndarray]:
        """Return the error sum of squares and the p-values of the model of some columns."""
        q, r = linalg.qr(self.r[:, columns], mode='economic')
        inverse = linalg.solve_triangular(r, np.eye(len(columns)))
        projected = q.T @ self.rotated
        rest = self.rotated - q @ projected
        sse = self.outside + float(rest @ rest)
        df = self.df_error(len(columns))
        with np.errstate(divide='ignore', invalid='ignore'):
            t = (inverse @ projected) / np.sqrt(sse / df * (inverse**2).sum(axis=1))
        return sse, np.nan_to_num(2 * stats.t.sf(np.abs(t), df), nan=1.0)


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
    return tuple(sorted(independent_terms(levels, [*terms, *added], blocks), key=term_key))


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
    kept = list(terms)
    basis = no_blocks(len(levels)) if blocks is None else blocks
    problem = _rotate(model_matrix(levels, kept), response, basis)
    index = {term: position for position, term in enumerate(kept)}
    sse, p = problem.sse_and_p([index[term] for term in kept])
    trace: list[Dropped] = []
    while True:
        free = _droppable(kept, hierarchy, protected)
        values = dict(zip(kept, p, strict=True))
        if not free or max(values[term] for term in free) <= alpha:
            return tuple(kept), tuple(trace)
        worst = max(free, key=lambda term: (round(values[term], 12), order(term), term))
        kept.remove(worst)
        sse, p = problem.sse_and_p([index[term] for term in kept])
        trace.append(_dropped(worst, float(values[worst]), sse, len(kept), problem))


def _rotate(matrix: np.ndarray, response: np.ndarray, basis: np.ndarray) -> _Reduced:
    q, r = linalg.qr(without_blocks(matrix, basis), mode='economic')
    free = without_blocks(response, basis)
    rotated = q.T @ free
    rest = free - q @ rotated
    sst = float(((response - response.mean()) ** 2).sum())
    return _Reduced(r, rotated, float(rest @ rest), len(response), basis.shape[1], sst)


def _droppable(
    kept: Sequence[str], hierarchy: bool, protected: Collection[str]
) -> tuple[str, ...]:
    return tuple(
        term
        for term in kept
        if term != CONSTANT
        and term not in protected
        and not (hierarchy and any(contains(other, term) for other in kept))
    )


def _dropped(term: str, p: float, sse: float, parameters: int, problem: _Reduced) -> Dropped:
    df = problem.df_error(parameters)
    r2 = 1 - sse / problem.sst if problem.sst > 0 else None
    adjusted = None if r2 is None else 1 - (sse / df) / (problem.sst / (problem.rows - 1))
    return Dropped(term, p, float(np.sqrt(sse / df)), r2, adjusted)
