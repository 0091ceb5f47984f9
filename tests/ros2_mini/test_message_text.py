# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import numpy as np
import pytest
from geometry_msgs.msg import PoseWithCovariance
from hexapod_interfaces.msg import FootContacts
from rcl_interfaces.msg import ParameterValue
from ros2_mini.message_text import message_to_csv, message_to_dict, message_to_yaml
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
JOINTS_WITHOUT_ARRAYS = """header:
  stamp:
    sec: 0
    nanosec: 0
  frame_id: base_link
name: '<sequence type: string, length: 2>'
position: '<sequence type: double, length: 2>'
velocity: '<sequence type: double, length: 0>'
effort: '<sequence type: double, length: 0>'
"""


def test_yaml_of_nested_fields_and_arrays(joints):
    assert message_to_yaml(joints) == JOINTS


def test_arrays_left_out(joints):
    assert message_to_yaml(joints, no_arr=True) == JOINTS_WITHOUT_ARRAYS
    shown = message_to_dict(PoseWithCovariance(), no_arr=True)
    assert shown['covariance'] == '<array type: double[36]>'


def test_strings_left_out_or_cut():
    message = String(data='abcdef')
    assert message_to_yaml(message, no_str=True) == "data: '<string length: <6>>'\n"
    assert message_to_yaml(message, truncate_length=3) == 'data: abc...\n'


def test_long_arrays_are_cut(joints):
    assert message_to_dict(joints, truncate_length=1)['position'] == [0.5, '...']
    assert message_to_dict(joints, truncate_length=2)['position'] == [0.5, -1.0]


def test_values_are_plain_python():
    shown = message_to_dict(PoseWithCovariance(covariance=np.arange(36.0)))
    assert shown['covariance'] == list(map(float, range(36)))
    assert type(shown['covariance'][1]) is float
    assert message_to_dict(FootContacts())['contact'] == [False] * 6
    assert message_to_dict(ByteMultiArray(data=[b'a']))['data'] == ['a']
    assert message_to_dict(ParameterValue())['double_array_value'] == []


def test_unicode_stays_readable():
    assert message_to_yaml(String(data='σ = 0.2')) == 'data: σ = 0.2\n'


def test_csv_is_flat_with_a_column_for_each_empty_array(joints):
    assert message_to_csv(joints) == '0,0,base_link,hip,knee,0.5,-1.0,,'
