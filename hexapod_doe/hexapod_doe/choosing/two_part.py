# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Two-part model of training runs: the probability of failure, and the reward given success.

E[Y] = (1 − π)·μ_success + π·μ_failed. What is stated with intervals comes from the unselected
models (failure and reward on terms up to order 2), whose intervals hold; the choice
comes from the models after elimination, which pick better.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy import special, stats

from hexapod_doe.choosing.draws import coefficient_draws
from hexapod_doe.designs.terms import is_interaction, order
from hexapod_doe.fitting.alias_matrix import without_arbitrary
from hexapod_doe.fitting.dispersion import Dispersion, dispersion, relative_deviation
from hexapod_doe.fitting.elimination import droppable, eliminate
from hexapod_doe.fitting.left_out import left_out
from hexapod_doe.fitting.logistic import LogisticFit, firth
from hexapod_doe.fitting.model import corners, estimable_terms, independent_terms, model_matrix
from hexapod_doe.fitting.regression import Fit, ols
from hexapod_doe.tables.table import RunTable

EVENTS_PER_TERM = 2
"""Failures, and successes, that a term of the failure model asks for."""


@dataclass(frozen=True)
class Parts:
    """Both fitted parts over the same factors."""

    factors: tuple[str, ...]
    failure_terms: tuple[str, ...]
    failure: LogisticFit
    success: Fit
    failed: np.ndarray
    """Responses of the failed runs."""
    levels: pd.DataFrame
    response: np.ndarray
    blocks: np.ndarray
    """Levels, responses and basis of block differences of the successful runs."""
    dispersion: Dispersion | None
    """Whether the spread of the successes differs by factor."""

    def point(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return P(failure), reward given success and expected reward of all 2^k (2^k,)."""
        grid = corners(self.factors)
        pi = self.failure.probability(model_matrix(grid, self.failure_terms))
        mu = model_matrix(grid, self.success.terms) @ self.success.coef
        return pi, mu, (1 - pi) * mu + pi * self.failed.mean()

    def draw(self, draws: int, rng: np.random.Generator) -> 'PartDraws':
        """Draw both parts' parameters and what they say of all combinations."""
        grid = corners(self.factors)
        odds = rng.multivariate_normal(self.failure.coef, self.failure.covariance, draws)
        pi = special.expit(odds @ model_matrix(grid, self.failure_terms).T)
        coef, s = coefficient_draws(self.success, draws, rng, self.dispersion)
        mu = coef @ model_matrix(grid, self.success.terms).T
        left = left_out(self.levels, self.success, grid)
        if left is not None:
            mu = mu + left.draw(draws, rng)
        ratio = relative_deviation(grid, self.levels, self.success, self.dispersion)
        return PartDraws(
            pi, mu, s[:, None] * ratio, _mean_draws(self.failed, draws, rng), self.failed
        )


@dataclass(frozen=True)
class PartDraws:
    """Draws of both parts. Shapes: (draws, 2^k), and (draws,) for the mean of failures."""

    pi: np.ndarray
    mu: np.ndarray
    s: np.ndarray
    mean_failed: np.ndarray
    failed: np.ndarray

    @property
    def expected(self) -> np.ndarray:
        """Expected reward of a run (draws, 2^k)."""
        return self.mixed_with(self.mu)

    def mixed_with(self, mu: np.ndarray) -> np.ndarray:
        """Return draws of the expected reward for draws of the reward given success."""
        return (1 - self.pi) * mu + self.pi * self.mean_failed[:, None]

    def future_mean(self, runs: int, rng: np.random.Generator) -> np.ndarray:
        """Draw the mean of some new runs of each combination (draws, 2^k)."""
        total = np.zeros_like(self.mu)
        for _ in range(runs):
            success = self.mu + self.s * rng.standard_normal(self.mu.shape)
            failed = rng.random(self.mu.shape) < self.pi
            total += np.where(failed, rng.choice(self.failed, self.mu.shape), success)
        return total / runs


def fit_parts(table: RunTable, threshold: float, alpha: float = 0.05) -> Parts | None:
    """Fit both parts without selection; None where there are too few failures or successes.

    Args:
        table: The runs.
        threshold: Runs below it failed.
        alpha: Significance of a difference in the spread of the successes.
    """
    failed = table.values < threshold
    blocks = table.block_basis(~failed)
    wanted = without_arbitrary(table.levels, estimable_terms(table.levels, 2))
    success_terms = independent_terms(table.levels[~failed], wanted, blocks)
    if not {term for term in wanted if order(term) == 1} <= set(success_terms):
        return None  # the successes are of too few cases
    runs = (~failed).sum() - blocks.shape[1]
    while failed.sum() >= 2 and runs - len(success_terms) < 2:
        highest = max(map(order, success_terms))
        if highest < 2:
            return None
        success_terms = tuple(term for term in success_terms if order(term) < highest)
    if failed.sum() < 2 or runs - len(success_terms) < 2:
        return None
    return _fit(table, failed, _failure_terms(table, failed), success_terms, alpha)


def _failure_terms(table: RunTable, failed: np.ndarray) -> tuple[str, ...]:
    """Return main effects and two-factor interactions, or main effects alone of few failures."""
    levels = table.levels
    pairs = without_arbitrary(levels, estimable_terms(levels, 2))
    if min(failed.sum(), (~failed).sum()) >= EVENTS_PER_TERM * len(pairs):
        return pairs
    return tuple(term for term in pairs if not is_interaction(term))


def select_parts(table: RunTable, parts: Parts, threshold: float, alpha: float) -> Parts:
    """Eliminate from both parts by p, keeping hierarchy.

    An interaction of the failure model must be significant among all of them (Bonferroni).
    """
    failed = table.values < threshold
    levels = table.levels
    terms = _select_failure(levels, failed.astype(float), parts, alpha)
    success, _ = eliminate(
        levels[~failed],
        table.values[~failed],
        parts.success.terms,
        alpha=alpha,
        blocks=parts.blocks,
    )
    return _fit(table, failed, terms, success, alpha)


def _select_failure(
    levels: pd.DataFrame, outcome: np.ndarray, parts: Parts, alpha: float
) -> tuple[str, ...]:
    terms, fit = list(parts.failure_terms), parts.failure
    interactions = max(1, sum(map(is_interaction, terms)))
    while True:
        z = np.abs(fit.coef) / np.sqrt(np.diag(fit.covariance))
        p = dict(zip(terms, 2 * stats.norm.sf(z), strict=True))
        for term in filter(is_interaction, terms):
            p[term] = min(1.0, p[term] * interactions)
        free = [term for term in droppable(terms) if p[term] > alpha]
        if not free:
            return tuple(terms)
        terms.remove(max(free, key=lambda term: (p[term], order(term), term)))
        fit = firth(model_matrix(levels, terms), outcome)


def _fit(
    table: RunTable,
    failed: np.ndarray,
    failure_terms: Sequence[str],
    success_terms: Sequence[str],
    alpha: float,
) -> Parts:
    levels, values = table.levels, table.values
    blocks = table.block_basis(~failed)
    success = ols(levels[~failed], values[~failed], success_terms, blocks)
    return Parts(
        factors=table.factors,
        failure_terms=tuple(failure_terms),
        failure=firth(model_matrix(levels, failure_terms), failed.astype(float)),
        success=success,
        failed=values[failed],
        levels=levels[~failed],
        response=values[~failed],
        blocks=blocks,
        dispersion=dispersion(levels[~failed], success, alpha),
    )


def _mean_draws(values: np.ndarray, draws: int, rng: np.random.Generator) -> np.ndarray:
    error = values.std(ddof=1) / np.sqrt(len(values))
    return values.mean() + error * rng.standard_t(len(values) - 1, draws)
