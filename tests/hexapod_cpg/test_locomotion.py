# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Walking as commanded, and the slow way back to the standing pose."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hexapod_cpg.cpg import Cpg
from hexapod_cpg.joint_guard import JointGuard
from hexapod_cpg.locomotion import Locomotion, Motion
from hexapod_cpg.mapping import ActionRanges, command_from_action
from hexapod_cpg.oscillator import HopfConfig
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from hexapod_sim import robot

RANGES = ActionRanges.of_article()

RATE, STOP_RATE = 6.2, 0.5
COMMAND = command_from_action(np.linspace(-1.0, 1.0, 30), 'D1', RANGES)


@pytest.fixture
def legs() -> Locomotion:
    return Locomotion(HopfConfig.of_article(), JointGuard(RATE), STOP_RATE)


def test_in_lock_step_the_pattern_generators_targets_are_played_as_they_are(legs) -> None:
    cpg = Cpg(HopfConfig.of_article())
    for _ in range(50):
        np.testing.assert_array_equal(legs.play(COMMAND), cpg.advance(COMMAND))
    assert legs.motion is Motion.WALKING


def test_a_stop_is_slow_and_ends_in_the_standing_pose(legs) -> None:
    for _ in range(30):
        legs.walk(COMMAND)
    position = legs.guard.position
    farthest = np.abs(position - robot.NEUTRAL_POSE).max()
    periods = 0
    while legs.motion is not Motion.STANDING:
        targets = legs.stop()
        steps = np.abs(np.diff(targets, axis=0, prepend=position[None]))
        assert steps.max() <= STOP_RATE * 0.005 * (1 + 1e-9)
        position = targets[-1]
        periods += 1
    np.testing.assert_array_equal(position, robot.NEUTRAL_POSE)
    assert periods == np.ceil(farthest / (STOP_RATE * 0.025) - 1e-9)
    np.testing.assert_array_equal(legs.stop(), np.tile(robot.NEUTRAL_POSE, (5, 1)))


def test_a_command_amid_a_stop_walks_on_from_where_the_legs_are(legs) -> None:
    for _ in range(30):
        legs.walk(COMMAND)
    legs.stop()
    assert legs.motion is Motion.STOPPING
    start = legs.guard.position
    targets = legs.walk(COMMAND)
    assert np.abs(np.diff(targets, axis=0, prepend=start[None])).max() <= RATE * 0.005 * (1 + 1e-9)
    assert legs.motion is Motion.WALKING


@pytest.mark.parametrize('value', [np.nan, np.inf, 1e300])
def test_a_command_of_no_use_is_refused_and_changes_nothing(legs, value: float) -> None:
    legs.walk(COMMAND)
    before = (legs.cpg.x.copy(), legs.guard.position.copy(), legs.motion)
    with np.errstate(all='ignore'), pytest.raises(ValueError, match='command'):
        legs.walk(replace(COMMAND, mu=np.full(6, value)))
    np.testing.assert_array_equal(legs.cpg.x, before[0])
    np.testing.assert_array_equal(legs.guard.position, before[1])
    assert legs.motion is before[2]


any_pose = arrays(np.float64, 18, elements=st.floats(-1.0, 1.0)).map(
    lambda share: np.clip(robot.JOINT_UPPER * share, robot.JOINT_LOWER, robot.JOINT_UPPER)
)


@given(any_pose, st.booleans())
def test_from_any_pose_the_legs_rise_slowly_to_stand_before_they_walk(pose, commanded) -> None:
    legs = Locomotion(HopfConfig.of_article(), JointGuard(RATE), STOP_RATE)
    legs.wait(HopfConfig.of_article())
    legs.rise(pose)
    position, periods = pose, 0
    while legs.motion is not Motion.STANDING:
        assert legs.motion is Motion.RISING
        targets = legs.walk(COMMAND) if commanded else legs.stop()
        steps = np.abs(np.diff(targets, axis=0, prepend=position[None]))
        assert steps.max() <= STOP_RATE * 0.005 * (1 + 1e-9)
        assert (targets >= robot.JOINT_LOWER).all()
        assert (targets <= robot.JOINT_UPPER).all()
        position = targets[-1]
        periods += 1
    np.testing.assert_array_equal(position, robot.NEUTRAL_POSE)
    # The rounding of many steps may cost one period more.
    needed = np.abs(pose - robot.NEUTRAL_POSE).max() / (STOP_RATE * 0.025)
    assert needed - 1e-9 <= periods <= needed + 2
    np.testing.assert_array_equal(
        legs.cpg.x, Cpg(HopfConfig.of_article()).x
    )  # the gait has not begun
    legs.walk(COMMAND)
    assert legs.motion is Motion.WALKING


def test_a_joint_measured_beyond_its_limit_begins_at_the_limit(legs) -> None:
    legs.rise(robot.JOINT_UPPER + 0.05)
    step = STOP_RATE * 0.005
    np.testing.assert_allclose(legs.stop()[0], robot.JOINT_UPPER - step, rtol=0, atol=1e-12)


def test_nothing_moves_before_somebody_tells_where_the_joints_are(legs) -> None:
    legs.wait(HopfConfig.of_article())
    for move in (legs.stop, lambda: legs.walk(COMMAND)):
        with pytest.raises(RuntimeError, match='expected rise'):
            move()
    assert legs.motion is Motion.WAITING
