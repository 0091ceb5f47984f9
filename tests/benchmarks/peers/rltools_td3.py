# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""One update of RLtools' TD3 (C++, compiled for these sizes), in ms.

It has no DDPG: its critics are two, and its layers all of one width. A step of its loop acts in
an environment, too, so the time of as many steps without updates is taken off. Run by
bench_learner in the environment of requirements-bench.txt, with its sizes as JSON; the compiler's
flags are RLtools' own. It prints the best of the rounds as its last line.
"""

import json
import sys
import time
from typing import Any

import gymnasium
import numpy as np
from gymnasium.envs.registration import EnvSpec
from rltools import TD3

STEPS = 100


class Constant(gymnasium.Env):
    """An environment that costs nothing."""

    spec = EnvSpec('Constant-v0', max_episode_steps=600)

    def __init__(self, observation: int, action: int) -> None:
        self.observation_space = gymnasium.spaces.Box(-1.0, 1.0, (observation,), np.float32)
        self.action_space = gymnasium.spaces.Box(-1.0, 1.0, (action,), np.float32)
        self._seen = np.linspace(-1.0, 1.0, observation, dtype=np.float32)

    def reset(self, **options: Any) -> tuple[Any, dict[str, Any]]:
        super().reset(**options)
        return self._seen, {}

    def step(self, _: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        return self._seen, 1.0, False, False, {}


def main() -> None:
    """Print the time."""
    sizes = json.loads(sys.argv[1])
    warmup = STEPS * sizes['rounds']
    limit = 2 * warmup + STEPS
    compiled = TD3(
        lambda: Constant(sizes['observation'], sizes['action']),
        enable_evaluation=False, interface_name='hexapod_bench', STEP_LIMIT=limit,
        N_WARMUP_STEPS=warmup,
        ACTOR_BATCH_SIZE=sizes['batch'], CRITIC_BATCH_SIZE=sizes['batch'],
        ACTOR_TRAINING_INTERVAL=1, CRITIC_TARGET_UPDATE_INTERVAL=1,
        ACTOR_TARGET_UPDATE_INTERVAL=1, ACTOR_HIDDEN_DIM=sizes['width'], ACTOR_NUM_LAYERS=3,
        CRITIC_HIDDEN_DIM=sizes['width'], CRITIC_NUM_LAYERS=3,
    )  # fmt: skip
    state = compiled.State(1)
    acting = best(state, sizes['rounds'] - 1)
    for _ in range(2 * STEPS):  # the rest of the warm-up, and the first updates
        state.step()
    learning = best(state, sizes['rounds'] - 1)
    print((learning - acting) * 1e3)


def best(state: Any, rounds: int) -> float:
    """Seconds of a step, the best mean of the rounds."""
    least = float('inf')
    for _ in range(rounds):
        start = time.process_time()
        for _ in range(STEPS):
            state.step()
        least = min(least, (time.process_time() - start) / STEPS)
    return least


if __name__ == '__main__':
    main()
