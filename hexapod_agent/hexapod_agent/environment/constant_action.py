# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Search for the best constant action: an agent that does not beat it has learned nothing.

The cross-entropy method (Rubinstein 1999) over the five numbers of a leg, the same for all legs:
a constant action that treats the sides differently walks in circles.
"""

from collections.abc import Callable

import numpy as np
from hexapod_cpg.mapping import ACTION_SIZE
from numpy.typing import NDArray

from hexapod_agent.algorithms.policies import constant_policy
from hexapod_agent.environment.env import HexapodLine
from hexapod_agent.environment.evaluation import run_episode, summarize

GENERATIONS, POPULATION, ELITE = 12, 20, 5
_LEGS = 6
_START_DEVIATION = 0.6
_LEAST_DEVIATION = 0.02  # keeps a generation from collapsing onto one action
# Not those of an evaluation: it is found on other starts than it is judged on.
_SEARCH_SEED, _SEARCH_STARTS = 1000, 4


def best_constant_action(
    env: HexapodLine, report: Callable[[int], None] = lambda generation: None
) -> NDArray[np.float32]:
    """Return the constant action (30,) with the highest mean return that the search finds.

    Args:
        env: Where actions are tried.
        report: Called with the number of each generation when it is done.
    """
    generator = np.random.default_rng(0)
    numbers = ACTION_SIZE // _LEGS
    mean, deviation = np.zeros(numbers), np.full(numbers, _START_DEVIATION)
    for generation in range(GENERATIONS):
        legs = generator.normal(mean, deviation, (POPULATION, numbers)).clip(-1.0, 1.0)
        returns = [_mean_return(env, leg) for leg in legs]
        elite = legs[np.argsort(returns)[-ELITE:]]
        mean, deviation = elite.mean(axis=0), elite.std(axis=0) + _LEAST_DEVIATION
        report(generation)
    return _for_all_legs(mean)


def _mean_return(env: HexapodLine, leg: NDArray[np.float64]) -> float:
    policy = constant_policy(_for_all_legs(leg))
    episodes = [run_episode(env, policy, _SEARCH_SEED, start) for start in range(_SEARCH_STARTS)]
    return summarize(episodes).final_average_reward


def _for_all_legs(leg: NDArray[np.float64]) -> NDArray[np.float32]:
    return np.tile(leg, _LEGS).astype(np.float32)
