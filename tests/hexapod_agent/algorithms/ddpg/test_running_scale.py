# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Observations are scaled by mean and deviation of what was seen in the episodes before."""

import numpy as np
import pytest
import torch
from hexapod_agent.algorithms.ddpg.running_scale import RunningScale
from hexapod_agent.algorithms.policies import SCALED_LIMIT
from hexapod_agent.algorithms.replay import Batch
from hexapod_agent.environment.env import HexapodLine
from hexapod_agent.train import train_episode
from hexapod_cpg.mapping import ACTION_SIZE


@pytest.fixture
def seen() -> np.ndarray:
    return np.random.default_rng(0).normal((0.5, -0.2), (0.1, 0.4), (50, 2)).astype(np.float32)


@pytest.fixture
def scale(seen) -> RunningScale:
    scale = RunningScale(2)
    for row in seen:
        scale.add(row)
    return scale


def test_nothing_is_scaled_before_the_first_refresh(scale):
    observation = np.array([0.3, -0.7], np.float32)
    np.testing.assert_array_equal(scale.scaled(observation), observation)


def test_scaled_observations_have_mean_zero_and_deviation_one(scale, seen):
    scale.refresh()
    inputs = torch.from_numpy(seen.copy())
    scale.scale(inputs)
    np.testing.assert_allclose(inputs.mean(dim=0), 0.0, atol=1e-5)
    np.testing.assert_allclose(inputs.std(dim=0, correction=0), 1.0, rtol=1e-5)
    for row, expected in zip(seen, inputs, strict=True):
        np.testing.assert_array_equal(scale.scaled(row), expected)


def test_what_is_far_off_counts_as_the_limit(scale):
    scale.refresh()
    far = np.array([9.0, -9.0], np.float32)
    np.testing.assert_array_equal(
        scale.scaled(far), np.array([SCALED_LIMIT, -SCALED_LIMIT], np.float32)
    )


def test_a_number_that_never_changes_is_not_blown_up():
    scale = RunningScale(1)
    for _ in range(5):
        scale.add(np.full(1, 0.7, np.float32))
    scale.refresh()
    # Deviation 0 counts as 0.02: a change by 0.01 is half a deviation.
    np.testing.assert_allclose(scale.scaled(np.full(1, 0.71, np.float32)), 0.5, rtol=1e-4)


def test_a_refresh_without_observations_changes_nothing():
    scale = RunningScale(1)
    scale.refresh()
    assert (scale.center.item(), scale.gain.item()) == (0.0, 1.0)


def test_state_carries_the_scale_and_what_was_seen(scale):
    scale.refresh()
    acting, going_on = RunningScale(2), RunningScale(2)
    state = scale.state_dict()
    acting.load_state_dict({name: state[name] for name in ('center', 'gain')})
    going_on.load_state_dict(scale.state_dict())
    for each in (scale, going_on):
        each.add(np.ones(2, np.float32))
    observation = np.array([0.3, -0.7], np.float32)
    for each in (acting, going_on):
        np.testing.assert_array_equal(each.scaled(observation), scale.scaled(observation))
    scale.refresh()
    going_on.refresh()
    np.testing.assert_array_equal(going_on.gain, scale.gain)
    assert not np.array_equal(acting.gain, scale.gain)


def test_a_trainer_scales_by_the_episodes_before(make_trainer, switched_config):
    trainer = make_trainer(config=switched_config)
    env = HexapodLine(trainer.spec.letters, switched_config)
    train_episode(env, trainer)
    assert (trainer.learner.scale.gain == 1.0).all()
    trainer.begin_episode(1)
    batch = Batch.empty(1, 500, trainer.spec.size, ACTION_SIZE, torch.float32)
    trainer.learner.sample(batch)
    deviation = batch.observation[0].std(dim=0)
    assert deviation.median() == pytest.approx(1.0, abs=0.15)
    assert batch.next_observation.abs().max() <= SCALED_LIMIT
