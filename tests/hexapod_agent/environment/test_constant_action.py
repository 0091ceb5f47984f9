# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The search for the best constant action, shortened."""

import numpy as np
import pytest
from hexapod_agent.algorithms.policies import constant_policy
from hexapod_agent.environment import constant_action
from hexapod_agent.environment.constant_action import best_constant_action
from hexapod_agent.environment.env import HexapodLine
from hexapod_agent.environment.evaluation import run_episode
from hexapod_agent.specification.run_spec import RunSpec


@pytest.fixture
def env(monkeypatch) -> HexapodLine:
    """An environment of 4 s episodes, and a search of three generations."""
    monkeypatch.setattr(constant_action, 'GENERATIONS', 3)
    monkeypatch.setattr(constant_action, 'POPULATION', 8)
    monkeypatch.setattr(constant_action, '_SEARCH_STARTS', 1)
    return HexapodLine('', RunSpec.from_mapping({'task': {'time_limit_steps': 160}}, 'test'))


def test_found_action_earns_more_than_the_zero_action_on_other_starts(env):
    generations: list[int] = []
    best = best_constant_action(env, generations.append)
    assert generations == [0, 1, 2]
    zero = np.zeros(30, np.float32)
    returns = [
        run_episode(env, constant_policy(action), 1, start).episode_return
        for action in (best, zero)
        for start in range(3)
    ]
    assert sum(returns[:3]) > sum(returns[3:])
    legs = best.reshape(6, 5)
    assert np.array_equal(legs, np.broadcast_to(legs[0], legs.shape))


def test_search_is_reproducible(env):
    assert np.array_equal(best_constant_action(env), best_constant_action(env))
