# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The search for the best walk without feedback, shortened."""

import numpy as np
import pytest
from hexapod_agent.algorithms.policies import constant_policy
from hexapod_agent.environment import open_loop
from hexapod_agent.environment.env import HexapodLine
from hexapod_agent.environment.evaluation import run_episode
from hexapod_agent.environment.open_loop import OpenLoopGait, best_open_loop
from hexapod_agent.specification.run_spec import RunSpec


@pytest.fixture
def spec(monkeypatch) -> RunSpec:
    """A run of episodes of 4 s, and a search of two generations."""
    monkeypatch.setattr(open_loop, 'GENERATIONS', 2)
    monkeypatch.setattr(open_loop, 'POPULATION', 8)
    monkeypatch.setattr(open_loop, '_SEARCH_STARTS', 1)
    return RunSpec.from_mapping({'task': {'time_limit_steps': 160}}, 'test')


def earned(gait: OpenLoopGait) -> float:
    """Return what a walk earns from starts that the search does not see."""
    env, policy = HexapodLine(config=gait.spec), constant_policy(gait.action)
    return sum(run_episode(env, policy, 1, start).episode_return for start in range(3))


@pytest.mark.parametrize('rhythm', [False, True])
def test_what_is_found_earns_more_than_the_zero_action_on_other_starts(spec, rhythm):
    generations: list[int] = []
    best = best_open_loop(spec, rhythm, generations.append)
    assert generations == [0, 1]
    assert earned(best) > earned(OpenLoopGait(np.zeros(30, np.float32), spec))
    legs = best.action.reshape(6, 5)
    assert np.array_equal(legs, np.broadcast_to(legs[0], legs.shape))
    changed = set(best.spec.differences(spec))
    expected = {'cpg.ranges.frequency', 'cpg.hopf.start_phase'} if rhythm else set()
    assert changed == expected
    centre, width = spec.cpg.ranges.frequency
    assert abs(best.spec.cpg.ranges.frequency[0] - centre) <= width


def test_the_search_is_reproducible(spec, monkeypatch):
    monkeypatch.setattr(open_loop, 'GENERATIONS', 1)
    monkeypatch.setattr(open_loop, 'POPULATION', 4)
    first, second = (best_open_loop(spec, True) for _ in range(2))
    assert np.array_equal(first.action, second.action)
    assert first.spec == second.spec
