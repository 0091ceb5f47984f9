# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Sensor messages become readings, joint arrays by name, and faults are named by field."""

from array import array

import numpy as np
import pytest
from hexapod_agent.nodes.messages import decode
from hexapod_sim.robot import JOINTS
from hexapod_sim.sensor_table import CHANNELS
from sensor_msgs.msg import JointState

JOINT_STATES = CHANNELS[0]
ANGLES = np.random.default_rng(7).normal(size=18)
VELOCITIES = np.random.default_rng(8).normal(size=18)


def message(order: list[int], extra: tuple[str, ...] = (), prefix: str = '') -> JointState:
    rest = [0.0] * len(extra)
    return JointState(
        name=[*extra, *(prefix + JOINTS[i] for i in order)],
        position=array('d', [*rest, *ANGLES[order]]),
        velocity=array('d', [*rest, *VELOCITIES[order]]),
    )


@pytest.mark.parametrize(
    ('order', 'extra', 'prefix'),
    [
        (list(range(18)), (), ''),
        (list(range(18))[::-1], (), ''),
        (np.random.default_rng(1).permutation(18).tolist(), ('gripper', 'pan'), 'px/'),
    ],
)
def test_joint_arrays_are_matched_by_name_bit_for_bit(order, extra, prefix) -> None:
    readings = decode(JOINT_STATES, {'joint_states': message(order, extra, prefix)})
    assert readings['joint_angles'].tobytes() == ANGLES.tobytes()
    assert readings['joint_velocities'].tobytes() == VELOCITIES.tobytes()


def test_a_short_array_names_topic_and_field() -> None:
    wrong = message(list(range(18)))
    wrong.velocity = wrong.velocity[:-1]
    with pytest.raises(ValueError, match='joint_states: velocity has 17 numbers for 18 names'):
        decode(JOINT_STATES, {'joint_states': wrong})


def test_a_missing_joint_is_named() -> None:
    wrong = message(list(range(17)))
    with pytest.raises(ValueError, match='joint_states: name lacks rr_ankle'):
        decode(JOINT_STATES, {'joint_states': wrong})
