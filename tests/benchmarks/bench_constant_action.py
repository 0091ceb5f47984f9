# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The best constant action beside the zero action: what an agent must beat to have learned."""

import numpy as np
from hexapod_agent.algorithms.policies import constant_policy
from hexapod_agent.environment.constant_action import best_constant_action
from hexapod_agent.environment.env import HexapodLine
from hexapod_agent.environment.evaluation import run_episode, summarize
from rich.console import Console

STARTS, SEED = 50, 1
NUMBERS = ('hip gain', 'knee gain', 'knee bias', 'ankle gain', 'ankle bias')


def main() -> None:
    """Print the best action of a leg, and the figures of both."""
    env, console = HexapodLine(), Console()
    best = best_constant_action(env)
    console.print(', '.join(f'{n} {v:+.2f}' for n, v in zip(NUMBERS, best[:5], strict=True)))
    for name, action in (('best', best), ('zero', np.zeros_like(best))):
        policy = constant_policy(action)
        console.print(name, summarize([run_episode(env, policy, SEED, k) for k in range(STARTS)]))


if __name__ == '__main__':
    main()
