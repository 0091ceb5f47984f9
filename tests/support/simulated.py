# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Campaigns of known truth, on which the analysis can be judged.

A run fails with a probability that depends on its set, and else earns a reward that does.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
import pandas as pd
from hexapod_doe.designs.design import Design
from hexapod_doe.fitting.model import model_matrix
from hexapod_doe.tables.table import BLOCK, RESPONSE, RunTable, build_rows
from scipy import special, stats

_GRID = 4001


@dataclass(frozen=True)
class Truth:
    """How runs come about; the numbers follow the synthetic campaign of the reference data."""

    success: Mapping[str, float] = field(
        default_factory=lambda: {
            '1': 420, 'A': 22, 'B': 30, 'C': 95, 'D': 18, 'E': 12, 'F': -10, 'G': -14,
            'AB': -15, 'CD': 16, 'CE': 20,
        }
    )  # fmt: skip
    """Coefficients of the mean reward of a successful run."""
    failure: Mapping[str, float] = field(
        default_factory=lambda: {'1': -1.53, 'B': -0.45, 'C': -0.55}
    )
    """Coefficients of the log-odds of failure: 20 % on average."""
    sigma: float = 40.0
    log_spread: Mapping[str, float] = field(default_factory=dict)
    """Coefficients of the logarithm of a successful run's deviation over sigma."""
    block_sigma: float = 0.0
    """Deviation of what the runs of a block share."""
    failed_mean: float = -40.0
    failed_sigma: float = 70.0

    def p_failure(self, levels: pd.DataFrame) -> np.ndarray:
        """Return the probability of failure (n,)."""
        return special.expit(_linear(levels, self.failure))

    def reward_success(self, levels: pd.DataFrame) -> np.ndarray:
        """Return the mean reward of a successful run (n,)."""
        return _linear(levels, self.success)

    def deviation(self, levels: pd.DataFrame) -> np.ndarray:
        """Return the deviation of a successful run (n,)."""
        if not self.log_spread:
            return np.full(len(levels), self.sigma)
        return self.sigma * np.exp(_linear(levels, self.log_spread))

    def mean(self, levels: pd.DataFrame) -> np.ndarray:
        """Return the mean reward of a run (n,)."""
        pi = self.p_failure(levels)
        return (1 - pi) * self.reward_success(levels) + pi * self.failed_mean

    def quantiles(self, levels: pd.DataFrame, probability: np.ndarray) -> np.ndarray:
        """Return quantiles of a run's reward (n, len(probability)), by inverting its mixture."""
        result = []
        parts = (self.p_failure(levels), self.reward_success(levels), self.deviation(levels))
        for pi, mu, sigma in zip(*parts, strict=True):
            low = min(self.failed_mean - 6 * self.failed_sigma, mu - 6 * sigma)
            grid = np.linspace(low, mu + 6 * sigma, _GRID)
            below = pi * stats.norm.cdf(grid, self.failed_mean, self.failed_sigma)
            below += (1 - pi) * stats.norm.cdf(grid, mu, sigma)
            result.append(np.interp(probability, below, grid))
        return np.array(result)

    def iqm(self, levels: pd.DataFrame) -> np.ndarray:
        """Return the mean of the middle half of a run's distribution (n,)."""
        return self.quantiles(levels, 0.25 + 0.5 * _midpoints()).mean(axis=1)

    def best_of(self, levels: pd.DataFrame, runs: int) -> np.ndarray:
        """Return the expected best of some runs (n,): E[F⁻¹(U^(1/m))]."""
        return self.quantiles(levels, _midpoints() ** (1 / runs)).mean(axis=1)

    def mean_of_best(self, levels: pd.DataFrame, kept: int, runs: int) -> np.ndarray:
        """Return the expected mean of the best `kept` of some runs (n,).

        The order statistics i of n are at quantiles of Beta(i, n + 1 − i).
        """
        u = _midpoints()
        weight = sum(stats.beta.pdf(u, i, runs + 1 - i) for i in range(runs - kept + 1, runs + 1))
        return (self.quantiles(levels, u) * weight).mean(axis=1) / kept

    def simulate(self, levels: pd.DataFrame, rng: np.random.Generator) -> np.ndarray:
        """Return the reward of one run of each row (n,), without what blocks share."""
        failed = rng.random(len(levels)) < self.p_failure(levels)
        success = rng.normal(self.reward_success(levels), self.deviation(levels))
        return np.where(
            failed, rng.normal(self.failed_mean, self.failed_sigma, len(levels)), success
        )


def repeated_levels(design: Design, replicates: int) -> pd.DataFrame:
    """Return the levels of a design, each case `replicates` times in a row."""
    levels = np.repeat(design.levels, replicates, axis=0)
    return pd.DataFrame(levels, columns=list(design.factors))


def table_of(
    levels: pd.DataFrame, response: np.ndarray, blocks: np.ndarray | None = None
) -> RunTable:
    """Return the table of simulated runs, in blocks if their labels are given (n,)."""
    factors = tuple(map(str, levels.columns))
    raw = levels.assign(**{RESPONSE: response}, **({} if blocks is None else {BLOCK: blocks}))
    rows, caveats = build_rows(raw, factors)
    column = '' if blocks is None else BLOCK
    return RunTable(
        'simulated', 'simulated', 'reward', factors, rows, caveats, block_column=column
    )


def _linear(levels: pd.DataFrame, coef: Mapping[str, float]) -> np.ndarray:
    return model_matrix(levels, coef) @ np.array(list(coef.values()), dtype=float)


def _midpoints(count: int = 4000) -> np.ndarray:
    return (np.arange(count) + 0.5) / count
