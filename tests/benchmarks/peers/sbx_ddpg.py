# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""One update of sbx's DDPG (JAX, a group of updates in one compiled loop), in ms.

Run by bench_learner in the environment of requirements-bench.txt, with its sizes as JSON; it
prints the best of the rounds as its last line.
"""

import json
import sys
import time
from typing import Any

import gymnasium
import numpy as np
from sbx import DDPG


class Noise(gymnasium.Env):
    """Observations and rewards at random: a learner's update does not depend on their meaning."""

    def __init__(self, observation: int, action: int) -> None:
        self.observation_space = gymnasium.spaces.Box(-1.0, 1.0, (observation,), np.float32)
        self.action_space = gymnasium.spaces.Box(-1.0, 1.0, (action,), np.float32)

    def reset(self, **options: Any) -> tuple[Any, dict[str, Any]]:
        super().reset(**options)
        return self.observation_space.sample(), {}

    def step(self, _: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        return self.observation_space.sample(), 1.0, False, False, {}


def main() -> None:
    """Print the time."""
    sizes = json.loads(sys.argv[1])
    layers = {'pi': sizes['actor'], 'qf': sizes['critic']}
    model = DDPG(
        'MlpPolicy', Noise(sizes['observation'], sizes['action']), batch_size=sizes['batch'],
        buffer_size=2000, policy_kwargs={'net_arch': layers}, learning_starts=100,
        train_freq=sizes['group'], gradient_steps=sizes['group'], seed=1,
    )  # fmt: skip
    model.learn(600)
    best = float('inf')
    for _ in range(sizes['rounds']):
        start = time.process_time()
        for _ in range(3):
            model.train(gradient_steps=sizes['group'], batch_size=sizes['batch'])
        best = min(best, (time.process_time() - start) / 3 / sizes['group'])
    print(best * 1e3)


if __name__ == '__main__':
    main()
