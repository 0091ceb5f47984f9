# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""How many runs a campaign with a stop rule is expected to take, before anything is known of it.

A rough forecast by simulated campaigns: no run fails, effects are about as large as the spread
of runs, and a few interactions half as large. The campaign itself asks its own analysis.
"""

from dataclasses import dataclass

import numpy as np

from hexapod_doe.designs.aliases import representatives
from hexapod_doe.designs.design import Design
from hexapod_doe.designs.planner import Option
from hexapod_doe.designs.terms import CONSTANT, is_interaction, model_matrix

EFFECT = 1.0
"""Deviation of the effects (a factor high against low), in standard deviations of a run."""
_INTERACTIONS = 3
_CAMPAIGNS, _DRAWS, _SETS = 100, 200, 256
_KEPT = 1.96
"""Standard errors beyond which the choice takes a term for real."""


@dataclass(frozen=True)
class Expected:
    """Runs that simulated campaigns took until their rule ended them."""

    mean: float
    low: int
    """A tenth took no more."""
    high: int
    """A tenth took no less."""


def expected_runs(
    design: Design, most: int, sigma: float, delta: float, least: int, rng: np.random.Generator
) -> Expected:
    """Simulate campaigns whose rule looks after each replicate.

    Args:
        design: The cases.
        most: Replicates of the whole plan.
        sigma: Standard deviation of a run.
        delta: Expected loss below which no new run is begun, in the same unit.
        least: Replicates before the first look.
        rng: Of the simulation.
    """
    terms = [CONSTANT, *representatives(design.levels, design.factors, 2)]
    points = model_matrix(_combinations(len(design.factors), rng), design.factors, terms)
    runs = []
    for _ in range(_CAMPAIGNS):
        truth = _drawn_effects(terms, sigma, rng)
        noise = rng.normal(0, sigma / np.sqrt(design.cases), (most, len(terms))).cumsum(axis=0)
        taken = most
        for replicates in range(least, most):
            error = sigma / np.sqrt(design.cases * replicates)
            found = truth + noise[replicates - 1] / replicates
            if _expected_loss(found, error, points, rng) < delta:
                taken = replicates
                break
        runs.append(design.cases * taken)
    low, high = np.quantile(runs, [0.1, 0.9], method='inverted_cdf')
    return Expected(float(np.mean(runs)), int(low), int(high))


def with_rule(option: Option, sigma: float | None, delta: float | None, least: int) -> str:
    """Return in a further line how many runs a stop rule is expected to take of a proposal.

    Args:
        option: The proposal.
        sigma: Standard deviation of a run, if it is known.
        delta: Expected loss below which no new run is begun; None without a rule.
        least: Replicates before the first look.

    Returns:
        Empty without a rule.

    Raises:
        ValueError: Sigma is not known.
    """
    if delta is None:
        return ''
    if sigma is None:
        raise ValueError('--stop-when is in the unit of --sigma, the SD of one run: give both')
    rng = np.random.default_rng(1)
    found = expected_runs(option.design, option.replicates, sigma, delta, least, rng)
    return (
        f'\nWith --stop-when {delta:g} about {found.mean:.0f} of {option.runs} runs are expected '
        f'(80 % of campaigns: {found.low} to {found.high}) if no run fails and effects scatter '
        f'by {EFFECT:g} standard deviation of a run; failing runs take more. Plan it --in-turns.'
    )


def _combinations(factors: int, rng: np.random.Generator) -> np.ndarray:
    """Return the levels of all combinations, or of some of very many (m, factors)."""
    numbers = np.arange(2**factors)
    if len(numbers) > _SETS:
        numbers = rng.choice(numbers, _SETS, replace=False)
    return 2 * (numbers[:, None] >> np.arange(factors) & 1) - 1


def _drawn_effects(terms: list[str], sigma: float, rng: np.random.Generator) -> np.ndarray:
    """Return coefficients of a truth (terms,), half the effects."""
    interaction = np.array([is_interaction(term) for term in terms])
    coef = rng.normal(0, EFFECT * sigma / 2, len(terms))
    few = rng.permutation(np.flatnonzero(interaction))[:_INTERACTIONS]
    coef[interaction & ~np.isin(np.arange(len(terms)), few)] = 0.0
    coef[few] /= 2
    return coef


def _expected_loss(
    found: np.ndarray, error: float, points: np.ndarray, rng: np.random.Generator
) -> float:
    """Return what the best of the clear terms loses by draws of all of them."""
    chosen = int((points @ np.where(np.abs(found) > _KEPT * error, found, 0.0)).argmax())
    draws = (found + error * rng.standard_normal((_DRAWS, len(found)))) @ points.T
    return float((draws.max(axis=1) - draws[:, chosen]).mean())
