# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""No target leaves the guard beyond a joint limit or rate; good ones leave as they came."""

from __future__ import annotations

import numpy as np
import pytest
from hexapod_cpg.cpg import Cpg
from hexapod_cpg.joint_guard import JointGuard
from hexapod_cpg.mapping import ActionRanges, command_from_action
from hexapod_cpg.oscillator import HopfConfig
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from hexapod_sim import robot

RANGES = ActionRanges.of_article()

RATE = 6.2
STEP = RATE * 0.005  # targets are 5 ms apart
STANDING = np.tile(robot.NEUTRAL_POSE, (robot.SUBSTEPS, 1))
any_targets = arrays(
    np.float64, (robot.SUBSTEPS, 18), elements=st.floats(-1e300, 1e300, allow_nan=False)
)


def rates(start: np.ndarray, targets: np.ndarray) -> np.ndarray:
    return np.abs(np.diff(targets, axis=0, prepend=start[None]))


@given(st.lists(any_targets, max_size=4))
def test_whatever_comes_in_limits_and_rates_hold(periods: list[np.ndarray]) -> None:
    guard = JointGuard(RATE)
    for targets in periods:
        start = guard.position
        safe = guard.follow(targets)
        assert (safe >= robot.JOINT_LOWER).all()
        assert (safe <= robot.JOINT_UPPER).all()
        assert rates(start, safe).max() <= STEP * (1 + 1e-12)
        np.testing.assert_array_equal(guard.position, safe[-1])


@given(any_targets)
def test_limits_alone_hold_whatever_comes_in(targets: np.ndarray) -> None:
    safe = JointGuard(RATE).limit(targets)
    np.testing.assert_array_equal(safe, np.clip(targets, robot.JOINT_LOWER, robot.JOINT_UPPER))


def test_a_walk_passes_bit_for_bit() -> None:
    cpg, guard = Cpg(HopfConfig.of_article()), JointGuard(RATE)
    command = command_from_action(np.zeros(30), 'D1', RANGES)
    guard.position = cpg.advance(command)[-1]
    for _ in range(100):
        targets = cpg.advance(command)
        np.testing.assert_array_equal(guard.follow(targets), targets)
    assert (guard.beyond_limit, guard.beyond_rate) == (0, 0)


def test_what_goes_beyond_is_counted_per_period() -> None:
    guard = JointGuard(RATE)
    guard.limit(STANDING)
    assert (guard.beyond_limit, guard.beyond_rate) == (0, 0)
    guard.limit(STANDING + 5.0)
    assert (guard.beyond_limit, guard.beyond_rate) == (1, 1)
    guard.limit(np.tile(robot.JOINT_UPPER, (robot.SUBSTEPS, 1)))
    assert (guard.beyond_limit, guard.beyond_rate) == (1, 1)


def test_the_way_to_a_pose_is_straight_and_ends_there() -> None:
    guard = JointGuard(RATE)
    guard.position = robot.NEUTRAL_POSE + 0.1
    # 0.1 rad at 0.5 rad/s takes 0.2 s: 8 control periods.
    for period in range(8):
        targets = guard.approach(robot.NEUTRAL_POSE, 0.5)
        expected = 0.1 - 0.0125 * (period + 1)
        assert targets[-1] - robot.NEUTRAL_POSE == pytest.approx(np.full(18, expected), abs=1e-12)
    guard.approach(robot.NEUTRAL_POSE, 0.5)
    np.testing.assert_array_equal(guard.position, robot.NEUTRAL_POSE)
