# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Search for the best walk without feedback: an agent that does not beat it has learned nothing.

CMA-ES (Hansen 2016, arXiv 1604.00772) over the five numbers of a leg's action, the same for all
legs: one that treats the sides differently walks in circles. An open-loop gait has two numbers
more, which an agent does not choose: frequency and first phase of the oscillators.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from hexapod_cpg.mapping import ACTION_SIZE, ACTIONS_PER_LEG
from numpy.typing import NDArray

from hexapod_agent.algorithms.policies import constant_policy
from hexapod_agent.environment.env import HexapodLine
from hexapod_agent.environment.evaluation import run_episode, summarize
from hexapod_agent.specification.run_spec import RunSpec

GENERATIONS, POPULATION = 20, 10
_START_DEVIATION = 0.5
# Not those of an evaluation: it is found on other starts than it is judged on.
_SEARCH_SEED, _SEARCH_STARTS = 1000, 4
_RHYTHM = 2


@dataclass(frozen=True)
class OpenLoopGait:
    """A walk that observes nothing.

    Attributes:
        action: What is done in every period (30,).
        spec: The run, with the gait's rhythm.
    """

    action: NDArray[np.float32]
    spec: RunSpec


def best_open_loop(
    spec: RunSpec, rhythm: bool, report: Callable[[int], None] = lambda generation: None
) -> OpenLoopGait:
    """Return the walk with the highest mean return that the search finds.

    Args:
        spec: The run in which walks are tried.
        rhythm: Whether frequency and first phase are searched, too, the one within
            `cpg.ranges.frequency`; else they are the run's, and so are those of its agents.
        report: Called with the number of each generation when it is done.
    """
    from cmaes import CMA  # most evaluations are of an agent, and need none

    numbers = ACTIONS_PER_LEG + _RHYTHM * rhythm
    search = CMA(
        mean=np.zeros(numbers),
        sigma=_START_DEVIATION,
        bounds=np.tile([-1.0, 1.0], (numbers, 1)),
        seed=0,
        population_size=POPULATION,
    )
    for generation in range(GENERATIONS):
        tried = [search.ask() for _ in range(POPULATION)]
        search.tell([(point, -_mean_return(_gait(spec, point))) for point in tried])
        report(generation)
    return _gait(spec, search.mean.clip(-1.0, 1.0))


def _gait(spec: RunSpec, point: NDArray[np.float64]) -> OpenLoopGait:
    """Return the walk of a point within +-1: a leg's action, and maybe frequency and phase."""
    leg, rhythm = point[:ACTIONS_PER_LEG], point[ACTIONS_PER_LEG:]
    if rhythm.size:
        (centre, width), phase = spec.cpg.ranges.frequency, spec.cpg.hopf.start_phase
        frequency = float(centre + width * rhythm[0])
        start = math.remainder(phase + math.pi * rhythm[1], 2.0 * math.pi)
        changes = {'ranges': {'frequency': [frequency, width]}, 'hopf': {'start_phase': start}}
        spec = spec.changed({'cpg': changes}, 'open-loop gait')
    legs = ACTION_SIZE // ACTIONS_PER_LEG
    return OpenLoopGait(np.tile(leg, legs).astype(np.float32), spec)


def _mean_return(gait: OpenLoopGait) -> float:
    env, policy = HexapodLine(config=gait.spec), constant_policy(gait.action)
    episodes = [run_episode(env, policy, _SEARCH_SEED, start) for start in range(_SEARCH_STARTS)]
    return summarize(episodes).final_average_reward
