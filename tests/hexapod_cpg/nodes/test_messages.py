# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Joint states of any driver as the pose that the robot starts from; bad ones are refused."""

from __future__ import annotations

import numpy as np
import pytest
from hexapod_cpg.nodes.messages import pose_from_message
from hexapod_node.invalid_message import fault_kind
from sensor_msgs.msg import JointState

from hexapod_sim import robot

CROUCHED = np.tile([0.3, 1.1, -0.9], 6)


def joint_state(pose: np.ndarray = CROUCHED) -> JointState:
    return JointState(name=list(robot.JOINTS), position=pose.tolist())


def test_joints_are_matched_by_name_and_need_no_velocity() -> None:
    message = joint_state()
    message.name = ['px/camera', *(f'px/{name}' for name in reversed(message.name))]
    message.position = [np.nan, *reversed(message.position)]
    np.testing.assert_array_equal(pose_from_message(message), CROUCHED)


def test_a_loaded_servo_may_lie_a_little_beyond_its_limit() -> None:
    pose = robot.JOINT_UPPER + 0.08  # its proportional band is 0.082 rad
    np.testing.assert_array_equal(pose_from_message(joint_state(pose)), pose)


@pytest.mark.parametrize(
    ('angle', 'kind', 'complaint'),
    [
        (np.nan, 'not_finite', 'joint_states: rf_knee is at nan rad, expected -1.2 to 1.2'),
        (-np.inf, 'not_finite', 'rf_knee is at -inf rad'),
        (1.3, 'beyond_limit', 'rf_knee is at 1.3 rad, expected -1.2 to 1.2'),
        (-14.3, 'beyond_limit', 'rf_knee is at -14.3 rad'),
    ],
)
def test_an_angle_that_the_joint_cannot_have_is_refused_by_name(angle, kind, complaint) -> None:
    message = joint_state()
    message.position[robot.JOINTS.index('rf_knee')] = angle
    with pytest.raises(ValueError, match=complaint) as refused:
        pose_from_message(message)
    assert fault_kind(refused.value) == kind


def test_missing_joints_and_numbers_are_named() -> None:
    message = joint_state()
    message.position.pop()
    with pytest.raises(ValueError, match='joint_states: position has 17 numbers for 18 names'):
        pose_from_message(message)
    message.name.pop()
    with pytest.raises(ValueError, match='joint_states: name lacks rr_ankle'):
        pose_from_message(message)
