# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Predictions averaged over models, so that neither a selection nor a name is taken for certain.

A Gibbs sampler walks over the models of main effects and two-factor interactions, aliases
included as alternatives, by exp(−BIC/2) times a prior that favours interactions of active
parents (Chipman, Hamada and Wu, Technometrics 39, 1997).
"""

import math
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from functools import cached_property

import numpy as np
import pandas as pd
from scipy import linalg

from hexapod_doe.choosing.draws import interval_of
from hexapod_doe.choosing.prediction import rank_descending
from hexapod_doe.designs.terms import CONSTANT, terms_up_to
from hexapod_doe.fitting.blocks import no_blocks, without_blocks
from hexapod_doe.fitting.model import (
    centre_points,
    corners,
    estimable_terms,
    labels,
    model_matrix,
    parents,
)
from hexapod_doe.fitting.regression import ols
from hexapod_doe.records.findings import Averaging, Estimate

P_MAIN = 0.5
P_INTERACTION = (0.01, 0.10, 0.25)
"""Prior probability of an interaction with none, one or both parents active."""
SWEEPS, BURN_IN = 400, 50
_SHOWN = 10
_LARGEST_EXPONENT = 700.0
_DEPENDENT = 1e-9
"""Share of the longest diagonal of R below which a column depends on those before it."""


class ModelSpace:
    """The models over some runs: their likelihood, their prior, and what they predict."""

    def __init__(
        self, levels: pd.DataFrame, response: np.ndarray, blocks: np.ndarray | None = None
    ) -> None:
        """Rotate the problem onto the columns of all terms, free of blocks."""
        self.factors = ''.join(map(str, levels.columns))
        self.terms = terms_up_to(self.factors, 2)
        matrix = model_matrix(levels, [CONSTANT, *self.terms])
        self.floor = 1e-12 * float(((response - response.mean()) ** 2).sum())
        basis = _absorbed(levels, no_blocks(len(response)) if blocks is None else blocks)
        self.centre = float(response.mean())
        response = without_blocks(response - self.centre, basis)
        q, self.r = linalg.qr(without_blocks(matrix, basis), mode='economic')
        self.rotated = q.T @ response
        rest = response - q @ self.rotated
        self.outside = float(rest @ rest)
        self._gram, self._moments = self.r.T @ self.r, self.r.T @ self.rotated
        self._total = float(response @ response)
        self.rows = len(response)
        self.absorbed = basis.shape[1]
        columns = matrix[:, 1:]
        self.alike = np.abs(columns.T @ columns) > (columns**2).sum(axis=0) - 1e-6
        np.fill_diagonal(self.alike, False)
        self._scores: dict[bytes, float] = {}

    @cached_property
    def _parents(self) -> np.ndarray:
        """Indices of the two parents of each interaction (interactions, 2)."""
        index = {term: i for i, term in enumerate(self.terms)}
        pairs = [[index[parent] for parent in parents(term)] for term in self.terms]
        return np.array([pair for pair in pairs if pair], dtype=int).reshape(-1, 2)

    def score(self, active: np.ndarray) -> float:
        """Return the log posterior of a model up to a constant."""
        key = active.tobytes()
        if key not in self._scores:
            self._scores[key] = self._score(active)
        return self._scores[key]

    def _score(self, active: np.ndarray) -> float:
        size = int(active.sum()) + 1
        if 2 * size > self.rows - self.absorbed or (self.alike[np.ix_(active, active)]).any():
            return -np.inf
        sse = self._sse(np.flatnonzero(np.concatenate([[True], active])))
        if sse is None:
            return -np.inf
        bic = self.rows * np.log(max(sse, self.floor) / self.rows) + size * np.log(self.rows)
        return float(self._log_prior(active) - bic / 2)

    def _sse(self, columns: np.ndarray) -> float | None:
        """Return the error sum of squares; None where the rows don't tell the terms apart.

        By the normal equations, which for ±1 columns and a centred response lose no digits that
        matter and take a tenth of the time: a sampler asks tens of thousands of times.
        """
        try:
            root = np.linalg.cholesky(self._gram[np.ix_(columns, columns)])
        except np.linalg.LinAlgError:
            return None
        diagonal = np.diag(root)
        if diagonal.min() < 1e-6 * diagonal.max():
            return None
        projected = np.linalg.solve(root, self._moments[columns])
        return max(self._total - float(projected @ projected), 0.0)

    def _log_prior(self, active: np.ndarray) -> float:
        chance = np.full(len(active), P_MAIN)
        mains = len(self.factors)  # the terms are sorted by order
        chance[mains:] = np.array(P_INTERACTION)[active[self._parents].sum(axis=1)]
        return float(np.log(np.where(active, chance, 1 - chance)).sum())

    def solve(self, active: np.ndarray) -> tuple[np.ndarray, float, np.ndarray]:
        """Return coefficients, error sum of squares and R⁻¹ of a model with the constant.

        The response is centred: the constant lacks `centre`.

        Raises:
            LinAlgError: The columns depend on each other, as in the few rows of some successes.
        """
        q, r = linalg.qr(self.r[:, np.concatenate([[True], active])], mode='economic')
        if np.abs(np.diag(r)).min() < _DEPENDENT * np.abs(np.diag(r)).max():
            raise linalg.LinAlgError('dependent columns')
        projected = q.T @ self.rotated
        rest = self.rotated - q @ projected
        inverse = np.linalg.inv(r)
        return inverse @ projected, self.outside + float(rest @ rest), inverse


def average(
    levels: pd.DataFrame,
    response: np.ndarray,
    spread: Callable[[np.ndarray], np.ndarray],
    level: float,
    rng: np.random.Generator,
    blocks: np.ndarray | None = None,
    decide: Callable[[np.ndarray], np.ndarray] | None = None,
) -> Averaging:
    """Average the values of all combinations over the models.

    Args:
        levels: Coded levels of the rows.
        response: Response that the models explain (n,).
        spread: Maps draws of the linear predictor to draws of the values (draws, 2^k).
        level: Confidence of the intervals.
        rng: For the sampler.
        blocks: Basis of the differences between blocks (n, b), which every model has.
        decide: As `spread`, for the order of the combinations; None for the same.
    """
    space = ModelSpace(levels, response, blocks)
    visited, eta = _sample(space, rng)
    eta = eta + _block_error(levels, response, blocks, len(eta), rng)
    values = spread(eta)
    ordered = (values if decide is None else decide(eta)).mean(axis=0)
    names = labels(corners(list(levels.columns)))
    return _summarise(space, visited, values, ordered, names, level)


def predictor_draws(
    levels: pd.DataFrame,
    response: np.ndarray,
    rng: np.random.Generator,
    blocks: np.ndarray | None = None,
) -> np.ndarray:
    """Draw the linear predictor of all combinations over the models (draws, 2^k).

    What all combinations share, the error of the mean over blocks, is left out.
    """
    return _sample(ModelSpace(levels, response, blocks), rng)[1]


def _sample(space: ModelSpace, rng: np.random.Generator) -> tuple[Counter[bytes], np.ndarray]:
    """Return how often each model was visited, and a draw of the linear predictor by each."""
    points = model_matrix(corners(list(space.factors)), [CONSTANT, *space.terms])
    visited: Counter[bytes] = Counter()
    draws = []
    active = np.zeros(len(space.terms), dtype=bool)
    for sweep in range(BURN_IN + SWEEPS):
        _gibbs_sweep(space, active, rng)
        if sweep >= BURN_IN:
            visited[active.tobytes()] += 1
            draws.append(_draw(space, active, points, rng))
    return visited, np.array(draws)


def _absorbed(levels: pd.DataFrame, blocks: np.ndarray) -> np.ndarray:
    """Return the basis of what every model has: blocks, and curvature at centre points.

    Without the latter centre points would pull the corners, which alone are predicted, to them.
    """
    centre = centre_points(levels)
    if not centre.any():
        return blocks
    return linalg.orth(np.column_stack([blocks, centre.astype(float)]))


def _block_error(
    levels: pd.DataFrame,
    response: np.ndarray,
    blocks: np.ndarray | None,
    draws: int,
    rng: np.random.Generator,
) -> np.ndarray:
    """Draw the error of the mean over blocks, which every set shares (draws, 1)."""
    if blocks is None or not blocks.shape[1]:
        return np.zeros((draws, 1))
    mains = ols(levels, response, estimable_terms(levels, 1, blocks), blocks)
    test = mains.blocks
    if test is None or mains.s is None:
        return np.zeros((draws, 1))
    between = test.ss / rng.chisquare(test.df, draws) - mains.s**2
    variance = np.maximum(0.0, between) / test.runs / test.count
    return (np.sqrt(variance) * rng.standard_normal(draws))[:, None]


def _gibbs_sweep(space: ModelSpace, active: np.ndarray, rng: np.random.Generator) -> None:
    """Flip each term by its conditional probability, then exchange aliases."""
    for i in rng.permutation(len(active)):
        active[i] = False
        without = space.score(active)
        active[i] = True
        active[i] = rng.random() < _chance(space.score(active), without)
    for i in np.flatnonzero(active & space.alike.any(axis=0)):
        group = [i, *np.flatnonzero(space.alike[i])]
        scores = []
        for j in group:
            active[group] = False
            active[j] = True
            scores.append(space.score(active))
        weights = np.exp(np.array(scores) - max(scores))
        active[group] = False
        active[rng.choice(group, p=weights / weights.sum())] = True


def _chance(with_: float, without: float) -> float:
    if with_ == -np.inf:
        return 0.0
    return 1 / (1 + math.exp(min(without - with_, _LARGEST_EXPONENT)))


def _draw(
    space: ModelSpace, active: np.ndarray, points: np.ndarray, rng: np.random.Generator
) -> np.ndarray:
    coef, sse, inverse = space.solve(active)
    s = np.sqrt(max(sse, space.floor) / rng.chisquare(space.rows - space.absorbed - len(coef)))
    drawn = coef + s * inverse @ rng.standard_normal(len(coef))
    return space.centre + points[:, np.concatenate([[True], active])] @ drawn


def _summarise(
    space: ModelSpace,
    visited: Mapping[bytes, int],
    draws: np.ndarray,
    ordered: np.ndarray,
    names: Sequence[str],
    level: float,
) -> Averaging:
    total = sum(visited.values())
    models = {key: np.frombuffer(key, dtype=bool) for key in visited}
    shares = {key: count / total for key, count in visited.items()}
    heaviest = sorted(shares, key=lambda key: -shares[key])[:_SHOWN]
    p_active = np.sum([shares[key] * models[key] for key in visited], axis=0)
    fits = draws.mean(axis=0)
    low, high = interval_of(draws, level)
    ranking = [names[i] for i in np.argsort(rank_descending(ordered))]
    return Averaging(
        models=len(visited),
        weights=tuple(
            (tuple(np.array(space.terms)[models[key]].tolist()), shares[key]) for key in heaviest
        ),
        p_active=dict(zip(space.terms, map(float, p_active), strict=True)),
        predictions={
            name: Estimate(float(fits[i]), (float(low[i]), float(high[i])))
            for i, name in enumerate(names)
        },
        ranking=tuple(ranking),
        choice=ranking[0],
    )
