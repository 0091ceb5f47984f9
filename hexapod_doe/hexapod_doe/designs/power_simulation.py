# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Power by simulation when some training runs fail, where the formula is far too hopeful."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import t as t_distribution

from hexapod_doe.designs.terms import CONSTANT, model_matrix


@dataclass(frozen=True)
class RunModel:
    """How one training run's response comes about: it succeeds, or it fails and earns little."""

    sigma: float = 1.0
    """Standard deviation of the successful runs, in reward units."""
    failure: float = 0.0
    """Probability that a run fails, whatever its case."""
    loss: float = 0.0
    """How far a failed run's mean lies below a successful one's, in reward units."""
    failure_sigma: float = 0.0
    """Standard deviation of the failed runs, in reward units."""

    def __post_init__(self) -> None:
        if not self.sigma > 0:
            raise ValueError(f'sigma {self.sigma}: expected a positive standard deviation')
        if not 0 <= self.failure < 1:
            raise ValueError(f'failure {self.failure}: expected a probability from 0 to below 1')


@dataclass(frozen=True)
class SimulatedPower:
    """The outcome of a power simulation."""

    power: float
    """Share of campaigns in which the real effect was significant."""
    power_se: float
    """Monte Carlo standard error of `power`."""
    false_alarms: float
    """Share of the other terms' tests that were significant although nothing is there."""
    repeats: int
    """Campaigns simulated."""


def simulate_power(
    levels: np.ndarray,
    factors: str,
    terms: Sequence[str],
    effect: float,
    replicates: int,
    model: RunModel,
    alpha: float = 0.05,
    repeats: int = 2000,
    seed: int = 0,
) -> SimulatedPower:
    """Simulate campaigns in which the first term has an effect on the successful runs.

    A failed run earns its low reward whatever the case, as a robot that lies on its back does:
    failures therefore both add noise and shrink the effect on the mean by their share.

    Args:
        levels: Coded levels of the cases. Shape: (cases, factors).
        factors: The letters of the columns.
        terms: The fitted terms without the constant; the first one carries the effect.
        effect: Its effect (high minus low) on the successful runs, in reward units.
        replicates: Runs of each case.
        model: How a run's response comes about.
        alpha: Significance level of the t tests.
        repeats: Campaigns to simulate.
        seed: Seed of the simulation.

    Raises:
        ValueError: The model leaves no degrees of freedom.
    """
    X = np.tile(model_matrix(levels, factors, [CONSTANT, *terms]), (replicates, 1))
    runs, parameters = X.shape
    if runs <= parameters:
        raise ValueError(f'{runs} runs, {parameters} parameters: expected more runs')
    y = _draw(effect / 2 * X[:, 1], model, repeats, np.random.default_rng(seed))
    significant = np.abs(_t_values(X, y)) > t_distribution.isf(alpha / 2, runs - parameters)
    return _summary(significant[:, 1:])


def _summary(significant: np.ndarray) -> SimulatedPower:
    """Count the significant tests, (repeats, terms), of which the first has something to find."""
    repeats = len(significant)
    share = float(significant[:, 0].mean())
    others = significant[:, 1:]
    return SimulatedPower(
        power=share,
        power_se=float(np.sqrt(share * (1 - share) / repeats)),
        false_alarms=float(others.mean()) if others.size else float('nan'),
        repeats=repeats,
    )


def _draw(mean: np.ndarray, model: RunModel, repeats: int, rng: np.random.Generator) -> np.ndarray:
    """Draw responses around the mean of the successes. Shape: (repeats, runs)."""
    size = (repeats, len(mean))
    success = mean + model.sigma * rng.standard_normal(size)
    failure = -model.loss + model.failure_sigma * rng.standard_normal(size)
    return np.where(rng.random(size) < model.failure, failure, success)


def _t_values(X: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Return the t value of each coefficient in each campaign. Shape: (repeats, parameters)."""
    Q, R = np.linalg.qr(X)
    inverse = np.linalg.inv(R)
    scores = y @ Q
    sse = np.sum(y**2, axis=1) - np.sum(scores**2, axis=1)
    s = np.sqrt(sse / (len(X) - X.shape[1]))
    return (scores @ inverse.T) / (s[:, None] * np.linalg.norm(inverse, axis=1))
