# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A public library trains on the environment as it is, without an adapter."""

import gymnasium
import numpy as np
from stable_baselines3 import DDPG


def test_stable_baselines3_trains_on_the_environment() -> None:
    env = gymnasium.make('hexapod_agent:HexapodLine-v0', observations='ABCDE')
    model = DDPG(
        'MlpPolicy',
        env,
        learning_starts=64,
        batch_size=64,
        policy_kwargs={'net_arch': [64, 64]},
        seed=1,
        device='cpu',
    )
    before = [parameter.detach().clone() for parameter in model.actor.parameters()]
    model.learn(300)
    assert model.num_timesteps == 300
    after = list(model.actor.parameters())
    assert any(not np.array_equal(a, b.detach()) for a, b in zip(before, after, strict=True))
    observation, _ = env.reset(seed=1)
    action, _ = model.predict(observation, deterministic=True)
    assert env.action_space.contains(action)
