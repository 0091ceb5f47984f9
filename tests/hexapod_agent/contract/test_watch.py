# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A topic under watch: sound messages pass, broken ones are named, some faults outlast them."""

from __future__ import annotations

from array import array

import numpy as np
import pytest
from geometry_msgs.msg import Quaternion, Vector3
from hexapod_agent.contract.watch import MessageWatch
from hexapod_sim.nodes.messages import SENSOR_TOPICS
from hexapod_sim.robot import GRAVITY, JOINTS
from hexapod_sim.sensor_table import CHANNELS
from hexapod_sim.task import LineTask
from hexapod_sim.task_config import TaskConfig
from sensor_msgs.msg import Imu, JointState

TABLE = {topic: channel for channel in CHANNELS for topic in channel.topics}


def imu(z: float = GRAVITY, frame: str = 'imu_link', w: float = 1.0, unmeasured: str = '') -> Imu:
    message = Imu(orientation=Quaternion(w=w), linear_acceleration=Vector3(z=z))
    if unmeasured:
        getattr(message, f'{unmeasured}_covariance')[0] = -1.0
    message.header.frame_id = frame
    return message


def watch(topic: str) -> MessageWatch:
    return MessageWatch(TABLE[topic], topic)


@pytest.mark.parametrize('sensor', SENSOR_TOPICS, ids=lambda sensor: sensor.name)
def test_what_the_sim_publishes_passes(sensor) -> None:
    task = LineTask(TaskConfig.of_article())
    task.reset(1)
    message = sensor.new()
    sensor.fill(message, task.sensors.read(sensor.channel))
    assert watch(sensor.name).check(message) is None


@pytest.mark.parametrize(
    ('message', 'kind'),
    [
        (imu(frame='x'), 'wrong_frame'),
        (imu(w=0.5), 'bad_quaternion'),
        (imu(unmeasured='orientation'), 'not_measured'),
        (imu(unmeasured='angular_velocity'), None),  # imu/data_raw has it for the agent
        (imu(), None),
    ],
)
def test_a_broken_message_is_named(message: Imu, kind: str | None) -> None:
    found = watch('imu/data').check(message)
    assert (found.kind if found else None) == kind


@pytest.mark.parametrize(
    ('change', 'kind'),
    [
        ({'name': ['a'] * 18}, 'wrong_names'),
        ({'position': array('d', [0.0] * 17)}, 'wrong_length'),
        ({'position': array('d', [np.nan] * 18)}, 'not_finite'),
        ({'position': array('d', [14.0] * 18)}, 'wrong_unit'),
    ],
)
def test_broken_joint_states_are_named(change: dict, kind: str) -> None:
    fields = {
        'name': list(JOINTS),
        'position': array('d', [0.1] * 18),
        'velocity': array('d', [0.1] * 18),
    }
    found = watch('joint_states').check(JointState(**(fields | change)))
    assert found is not None
    assert found.kind == kind


def test_a_wrong_unit_outlasts_the_message_by_a_second() -> None:
    watched = watch('imu/data_raw')
    fast, slow = imu(), imu()
    fast.angular_velocity.x = 40.0
    assert watched.check(fast).kind == 'wrong_unit'
    for _ in range(39):
        assert watched.check(slow).kind == 'wrong_unit'
    assert watched.check(slow) is None


def test_an_acceleration_in_g_is_named_within_seconds() -> None:
    watched = watch('imu/data')
    for _ in range(80):
        found = watched.check(imu(1.0))
    assert found is not None
    assert (found.kind, found.field) == ('wrong_unit', 'linear_acceleration')
    assert 'looks like g' in found.found


def test_flipped_gravity_is_named_within_half_a_second_and_a_jolt_is_not() -> None:
    watched = watch('imu/data')
    assert watched.check(imu(-30.0)) is None
    for _ in range(60):
        assert watched.check(imu()) is None
    found = [watched.check(imu(-GRAVITY)) for _ in range(20)]
    assert found[0] is None
    assert found[-1] is not None
    assert found[-1].kind == 'flipped_gravity'
    for _ in range(200):
        last = watched.check(imu())
    assert last is None


@pytest.mark.parametrize('number', [1e300, -1e300, 1e-320])
def test_wild_numbers_are_survived_and_forgotten_within_seconds(number: float) -> None:
    watched = watch('imu/data')
    wild = imu(z=number, w=number)
    wild.orientation.x = -number
    assert watched.check(wild).kind == 'bad_quaternion'
    for _ in range(120):
        last = watched.check(imu())
    assert last is None
