# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A fake device has its own names, can be broken, and refuses what does not suit its channel."""

from __future__ import annotations

import numpy as np
import pytest
from hexapod_sim.fake_device import DEVICES, FakeDevice, fault_names, faults
from hexapod_sim.message_fields import read, write
from hexapod_sim.nodes.fake_driver_node import PARAMETERS
from hexapod_sim.nodes.messages import SENSOR_TOPICS
from hexapod_sim.robot import JOINTS, LEGS, NEUTRAL_POSE, SUBSTEPS
from hexapod_sim.task import LineTask
from hexapod_sim.task_config import TaskConfig
from rclpy.serialization import deserialize_message, serialize_message

DEFAULTS = {entry.name: entry.default for entry in PARAMETERS}
SENSORS = {sensor.name: sensor for sensor in SENSOR_TOPICS}
TOPICS = [(device, topic) for device in DEVICES for topic in DEVICES[device].topics]
FAULTS = [(device, fault) for device in DEVICES for fault in faults(DEVICES[device])]


@pytest.fixture(scope='module')
def task() -> LineTask:
    made = LineTask(TaskConfig.of_article())
    made.reset(1)
    made.advance(np.tile(0.8 * NEUTRAL_POSE, (SUBSTEPS, 1)))  # nothing is zero in motion
    return made


def message(topic: str, task: LineTask):
    sensor = SENSORS[topic]
    made = sensor.new()
    sensor.fill(made, task.sensors.read(sensor.channel))
    return made


def device(**settings: object) -> FakeDevice:
    return FakeDevice(DEFAULTS | settings)


def of_device(device: FakeDevice, topic: str, made, fault: str = ''):
    assert device.measure(made, topic, 0)
    device.fill(made, topic, fault)
    return made


def test_every_sensor_topic_of_the_sim_has_a_driver() -> None:
    assert {topic for _, topic in TOPICS} == {*SENSORS}


@pytest.mark.parametrize(('channel', 'topic'), TOPICS)
def test_what_is_written_is_read_and_fits_the_message(channel, topic, task) -> None:
    made = message(topic, task)
    for field in DEVICES[channel].fields:
        values = np.full_like(read(made, field.path), 0.25)
        if field.kind == 'switch':
            values = np.round(values)
        write(made, field.path, values)
        copy = deserialize_message(serialize_message(made), type(made))
        np.testing.assert_array_equal(read(copy, field.path), values)


@pytest.mark.parametrize(('channel', 'topic'), TOPICS)
def test_a_perfect_device_changes_no_bit(channel, topic, task) -> None:
    found = of_device(device(channel=channel), topic, message(topic, task))
    assert found == message(topic, task)  # serialised, bytes of padding may differ


@pytest.mark.parametrize(('channel', 'fault'), FAULTS)
def test_a_fault_changes_the_message_and_can_still_be_sent(channel, fault, task) -> None:
    for topic in DEVICES[channel].topics:
        broken = of_device(device(channel=channel), topic, message(topic, task), fault)
        deserialize_message(serialize_message(broken), type(broken))
        assert broken != message(topic, task)


def test_faults_are_listed_by_channel() -> None:
    assert fault_names(DEVICES['foot_contacts']) == ('stopped', 'stale_stamps')
    assert 'flipped_gravity' in fault_names(DEVICES['imu/data_raw'])
    assert 'wrong_length' in fault_names(DEVICES['joint_torques'])
    assert {name for row in DEVICES.values() for name in fault_names(row)} == {
        'stopped', 'stale_stamps', 'nan', 'wrong_length', 'wrong_names', 'wrong_frame',
        'bad_quaternion', 'flipped_gravity', 'wrong_unit',
    }  # fmt: skip


def test_a_shuffled_layout_moves_names_and_numbers_together(task) -> None:
    servos = device(
        channel='joint_states', joint_order='shuffled', joint_prefix='px/', extra_joints=3
    )
    ours = message('joint_states', task)
    made = of_device(servos, 'joint_states', message('joint_states', task))
    assert len(made.name) == len(made.position) == len(made.velocity) == 21
    assert sorted(name for name in made.name if name.startswith('extra')) == [
        'extra_0', 'extra_1', 'extra_2',
    ]  # fmt: skip
    for index, joint in enumerate(JOINTS):
        place = made.name.index(f'px/{joint}')
        assert made.position[place] == ours.position[index]
        assert made.velocity[place] == ours.velocity[index]


def test_topics_and_frames_are_its_own_for_each_leg(task) -> None:
    cells = device(channel='foot_force', topic='cells/force', frame='cell')
    assert cells.row.topics == tuple(f'foot_force/{leg}' for leg in LEGS)
    made = of_device(cells, 'foot_force/rm', message('foot_force/rm', task))
    assert cells.own_topic('foot_force/rm') == 'cells/force/rm'
    assert made.header.frame_id == 'cell_rm'


def test_without_names_of_its_own_the_topic_says_driver() -> None:
    assert device(channel='imu/data').own_topic('imu/data') == 'driver/imu/data'


@pytest.mark.parametrize(
    ('settings', 'complaint'),
    [
        ({'joint_prefix': 'px/'}, r'joint_\*: expected a channel with joints, not imu/data'),
        (
            {'channel': 'joint_states', 'extra_joints': 2},
            'extra_joints 2: expected joint_order shuffled',
        ),
        (
            {'channel': 'foot_contacts', 'bias': 0.1},
            r'sensors.foot_contacts.bias is 0.1',
        ),
    ],
)
def test_what_does_not_suit_the_channel_is_refused(settings: dict, complaint: str) -> None:
    with pytest.raises(ValueError, match=complaint):
        device(**settings)
