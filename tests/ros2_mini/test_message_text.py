# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import numpy as np
import pytest
from geometry_msgs.msg import PoseWithCovariance
from hexapod_interfaces.msg import FootContacts
from rcl_interfaces.msg import ParameterValue
from ros2_mini.message_text import message_to_yaml, plain
from sensor_msgs.msg import JointState
from std_msgs.msg import ByteMultiArray, String


@pytest.fixture
def joints() -> JointState:
    message = JointState(name=['hip', 'knee'], position=[0.5, -1.0])
    message.header.frame_id = 'base_link'
    return message


# What `ros2 topic echo` of ros2topic 0.32.2 prints of these messages.
JOINTS = """header:
  stamp:
    sec: 0
    nanosec: 0
  frame_id: base_link
name:
- hip
- knee
position:
- 0.5
- -1.0
velocity: []
effort: []
"""


def test_yaml_of_nested_fields_and_arrays(joints):
    assert message_to_yaml(joints) == JOINTS


def test_long_strings_and_arrays_are_cut(joints):
    assert message_to_yaml(String(data='abcdef'), 3) == 'data: abc...\n'
    assert plain(joints, 1)['position'] == [0.5, '...']
    assert plain(joints, 2)['position'] == [0.5, -1.0]


def test_values_are_plain_python():
    shown = plain(PoseWithCovariance(covariance=np.arange(36.0)))
    assert shown['covariance'] == list(map(float, range(36)))
    assert type(shown['covariance'][1]) is float
    assert plain(FootContacts())['contact'] == [False] * 6
    assert plain(ByteMultiArray(data=[b'a']))['data'] == ['a']
    assert plain(ParameterValue())['double_array_value'] == []


def test_unicode_stays_readable():
    assert message_to_yaml(String(data='σ = 0.2')) == 'data: σ = 0.2\n'
