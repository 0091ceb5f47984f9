# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import array

import numpy as np
import pytest
from builtin_interfaces.msg import Time
from geometry_msgs.msg import PoseStamped, PoseWithCovariance
from hexapod_interfaces.action import TrainRun
from hexapod_interfaces.msg import CpgCommand, FootContacts
from ros2_mini.errors import CommandError
from ros2_mini.message_fill import fill_message, read_values
from ros2_mini.message_text import message_to_dict
from sensor_msgs.msg import Image, JointState
from std_msgs.msg import Bool, Float32, Header, Int8, String, UInt8MultiArray


def filled(message, text: str):
    assert fill_message(message, read_values(text)) == []
    return message


def test_what_is_written_can_be_read_again():
    first = JointState(name=['hip'], position=[0.5], velocity=[1.0], effort=[])
    first.header.stamp.sec = 7
    second = JointState()
    fill_message(second, message_to_dict(first))
    assert second == first


@pytest.mark.parametrize(
    ('message', 'text', 'expected'),
    [
        (Float32(), 'data: 1', 1.0),
        (Float32(), 'data: 1e3', 1000.0),  # a string to YAML 1.1
        (Float32(), 'data: .5', 0.5),
        (Int8(), 'data: -128', -128),
        (Int8(), 'data: 5.0', 5),
        (Bool(), 'data: true', True),
        (Bool(), 'data: 0', False),
        (String(), 'data: 12', '12'),
        (String(), '', ''),
        (UInt8MultiArray(), 'data: [1, 255]', array.array('B', [1, 255])),
    ],
)
def test_values_become_the_type_of_their_field(message, text, expected):
    found = filled(message, text).data
    assert found == expected
    assert type(found) is type(expected)


def test_arrays_and_nested_messages():
    command = filled(CpgCommand(), 'mu: [1, 2, 3, 4, 5, 6]')
    assert command.mu.dtype == np.float64
    assert command.mu.tolist() == [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]
    pose = filled(PoseStamped(), '{header: {frame_id: odom}, pose: {position: {x: 1}}}')
    assert (pose.header.frame_id, pose.pose.position.x) == ('odom', 1.0)
    goal = filled(TrainRun.Goal(), 'metadata: [{key: a, value: b}, {key: c}]')
    assert [(entry.key, entry.value) for entry in goal.metadata] == [('a', 'b'), ('c', '')]


@pytest.mark.parametrize(
    ('message', 'text', 'error'),
    [
        (String(), 'dat: x', "'dat' is 'x', expected a field of String, which has: data"),
        (Int8(), 'data: 128', "'data' is 128, expected a int8, -128 to 127"),
        (Int8(), 'data: 1.5', "'data' is 1.5, expected a int8"),
        (Int8(), 'data: true', "'data' is True, expected a int8"),
        (Float32(), 'data: x', "'data' is 'x', expected a number"),
        (Float32(), 'data: true', "'data' is True, expected a number"),
        (Bool(), "data: 'no'", "'data' is 'no', expected true or false"),
        (String(), 'data: [1]', "'data' is .1., expected a string"),
        (CpgCommand(), 'mu: [1, 2]', "'mu' is .1, 2., expected 6 elements, not 2"),
        (CpgCommand(), 'mu: 1', "'mu' is 1, expected a list"),
        (UInt8MultiArray(), 'data: [1, 256]', "'data.1.' is 256, expected a uint8, 0 to 255"),
        (PoseStamped(), 'pose: {position: 1}', "'pose.position' is 1, expected the fields of a"),
        (PoseStamped(), 'pose: {place: 1}', "'pose.place' is 1, expected a field of Pose, which"),
        (FootContacts(), 'contact: [1, 1, 1, 1, 1, x]', "'contact.5.' is 'x', expected true"),
        (Image(), 'height: -1', "'height' is -1, expected a uint32, 0 to 4294967295"),
        (PoseWithCovariance(), 'covariance: [a]', 'expected 36 elements, not 1'),
    ],
)
def test_error_names_field_value_and_expectation(message, text, error):
    with pytest.raises(CommandError, match=f'^Failed to populate field: .*{error}'):
        filled(message, text)


def test_times_of_publishing_are_set_later():
    pose, stamp = PoseStamped(), Time()
    (set_header,) = fill_message(pose, read_values('header: auto'))
    (set_stamp,) = fill_message(Header(), read_values('stamp: now'))
    now = Time(sec=5)
    set_header(now)
    set_stamp(now)
    assert pose.header.stamp == now
    (set_own,) = fill_message(header := Header(), {'stamp': 'now'})
    set_own(now)
    assert header.stamp == now != stamp


@pytest.mark.parametrize(
    ('text', 'error'),
    [('[1]', r"needs to be a dictionary.*'\[1\]'"), ('{a', "'{a' is no YAML: while parsing")],
)
def test_text_that_is_no_mapping(text, error):
    with pytest.raises(CommandError, match=error):
        read_values(text)
