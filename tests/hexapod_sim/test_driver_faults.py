# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The messages of every sensor topic can be read, changed and broken by a driver."""

from __future__ import annotations

import numpy as np
import pytest
from hexapod_interfaces.msg import LineOffset
from hexapod_sim.driver_faults import ALL_FAULTS, DEVICES, fault_names, faults
from hexapod_sim.joint_layout import JointLayout
from hexapod_sim.message_fields import read, write
from hexapod_sim.nodes.messages import SENSOR_TOPICS
from hexapod_sim.robot import JOINTS, NEUTRAL_POSE, SUBSTEPS
from hexapod_sim.simulation import Simulation
from rclpy.serialization import deserialize_message, serialize_message

from hexapod_sim import sensors

SENSORS = {sensor.name: sensor for sensor in SENSOR_TOPICS}
TOPICS = [(device, topic) for device in DEVICES for topic in DEVICES[device].topics]
FAULTS = [(device, fault) for device in DEVICES for fault in faults(DEVICES[device])]


@pytest.fixture(scope='module')
def simulation() -> Simulation:
    made = Simulation()
    made.reset(0.0)
    made.advance(np.tile(0.8 * NEUTRAL_POSE, (SUBSTEPS, 1)))  # nothing is zero in motion
    return made


def message(topic: str, simulation: Simulation):
    if topic == 'line_offset':
        return LineOffset(offset=0.5)
    sensor = SENSORS[topic]
    made = sensor.new()
    sensor.fill(made, sensors.read(simulation, sensor.readings))
    return made


def test_every_sensor_topic_of_the_sim_has_a_driver() -> None:
    assert {topic for _, topic in TOPICS} == {*SENSORS, 'line_offset'}


@pytest.mark.parametrize(('channel', 'topic'), TOPICS)
def test_what_is_written_is_read_and_fits_the_message(channel, topic, simulation) -> None:
    made = message(topic, simulation)
    for field in DEVICES[channel].fields:
        values = np.full_like(read(made, field.path), 0.25)
        if field.kind == 'switch':
            values = np.round(values)
        write(made, field.path, values)
        copy = deserialize_message(serialize_message(made), type(made))
        np.testing.assert_array_equal(read(copy, field.path), values)


def test_a_shuffled_layout_moves_names_and_numbers_together(simulation) -> None:
    ours, made = (message('joint_states', simulation) for _ in range(2))
    JointLayout.shuffled(18, 3, 'px/', seed=4).apply(made)
    assert len(made.name) == len(made.position) == len(made.velocity) == 21
    assert sorted(name for name in made.name if name.startswith('extra')) == [
        'extra_0', 'extra_1', 'extra_2',
    ]  # fmt: skip
    for index, joint in enumerate(JOINTS):
        place = made.name.index(f'px/{joint}')
        assert made.position[place] == ours.position[index]
        assert made.velocity[place] == ours.velocity[index]


@pytest.mark.parametrize(('channel', 'fault'), FAULTS)
def test_a_fault_changes_the_message_and_can_still_be_sent(channel, fault, simulation) -> None:
    for topic in DEVICES[channel].topics:
        sound, broken = (message(topic, simulation) for _ in range(2))
        faults(DEVICES[channel])[fault](broken)
        assert serialize_message(broken) != serialize_message(sound)


def test_faults_are_listed_by_channel() -> None:
    assert fault_names(DEVICES['foot_contacts']) == ('stopped', 'stale_stamps')
    assert 'flipped_gravity' in fault_names(DEVICES['imu/data_raw'])
    assert 'wrong_length' in fault_names(DEVICES['joint_torques'])
    assert set(ALL_FAULTS) == {
        'stopped', 'stale_stamps', 'nan', 'wrong_length', 'wrong_names', 'wrong_frame',
        'bad_quaternion', 'flipped_gravity', 'wrong_unit',
    }  # fmt: skip
