# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The best constant action: what an agent must beat to have learned to use its observations.

Run: `python tests/benchmarks/bench_constant_action.py`. The cross-entropy method (Rubinstein
1999) searches the five numbers of a leg, the same for all legs: a constant action that treats
the sides differently walks in circles. Found on other starts than it is judged on.
"""

import numpy as np
from hexapod_agent.env import HexapodLine
from hexapod_agent.evaluation import Evaluation, run_episode, summarize
from hexapod_agent.policies import constant_policy
from numpy.typing import NDArray
from rich.console import Console
from rich.progress import track

GENERATIONS, POPULATION, ELITE = 12, 20, 5
SEARCH_STARTS, JUDGE_STARTS = 4, 50
SEARCH_SEED, JUDGE_SEED = 1000, 1
NAMES = ('hip gain', 'knee gain', 'knee bias', 'ankle gain', 'ankle bias')


def judge(env: HexapodLine, leg: NDArray[np.float64], seed: int, starts: int) -> Evaluation:
    """Evaluate the action that every leg repeats."""
    policy = constant_policy(np.tile(leg, 6).astype(np.float32))
    return summarize([run_episode(env, policy, seed, start) for start in range(starts)])


def search(env: HexapodLine) -> NDArray[np.float64]:
    """Find the five numbers with the highest mean return."""
    generator = np.random.default_rng(0)
    mean, deviation = np.zeros(5), np.full(5, 0.6)
    for _ in track(range(GENERATIONS), 'search'):
        legs = generator.normal(mean, deviation, (POPULATION, 5)).clip(-1.0, 1.0)
        returns = [
            judge(env, leg, SEARCH_SEED, SEARCH_STARTS).final_average_reward for leg in legs
        ]
        elite = legs[np.argsort(returns)[-ELITE:]]
        mean, deviation = elite.mean(axis=0), elite.std(axis=0) + 0.02
    return mean


def main() -> None:
    """Print the best action, its figures, and those of the zero action."""
    env, console = HexapodLine(), Console()
    best = search(env)
    console.print(', '.join(f'{n} {v:+.2f}' for n, v in zip(NAMES, best, strict=True)))
    console.print('best', judge(env, best, JUDGE_SEED, JUDGE_STARTS))
    console.print('zero', judge(env, np.zeros(5), JUDGE_SEED, JUDGE_STARTS))


if __name__ == '__main__':
    main()
