# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The best walks without feedback beside the zero action: what an agent must beat."""

import numpy as np
from hexapod_agent.algorithms.policies import constant_policy
from hexapod_agent.environment.env import HexapodLine
from hexapod_agent.environment.evaluation import run_episode, summarize
from hexapod_agent.environment.open_loop import OpenLoopGait, best_open_loop
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_cpg.mapping import ACTION_SIZE
from rich.console import Console

STARTS, SEED = 50, 1
NUMBERS = ('hip gain', 'knee gain', 'knee bias', 'ankle gain', 'ankle bias')


def main() -> None:
    """Print the action of a leg, the rhythm and the figures of each."""
    spec, console = RunSpec.load(), Console()
    walks = {
        'open-loop': best_open_loop(spec, rhythm=True),
        'constant': best_open_loop(spec, rhythm=False),
        'zero': OpenLoopGait(np.zeros(ACTION_SIZE, np.float32), spec),
    }
    for name, walk in walks.items():
        cpg, numbers = walk.spec.cpg, zip(NUMBERS, walk.action[:5], strict=True)
        console.print(name, ', '.join(f'{number} {value:+.2f}' for number, value in numbers))
        console.print(f'{cpg.ranges.frequency[0]:.2f} rad/s from {cpg.hopf.start_phase:.2f} rad')
        env, policy = HexapodLine(config=walk.spec), constant_policy(walk.action)
        console.print(summarize([run_episode(env, policy, SEED, k) for k in range(STARTS)]))


if __name__ == '__main__':
    main()
