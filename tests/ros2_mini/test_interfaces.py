# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import pytest
from ros2_mini.cli import main
from ros2_mini.errors import CommandError
from ros2_mini.interfaces import interface_names, load_type
from std_msgs.msg import String


def test_types_by_long_and_short_name():
    assert load_type('std_msgs/msg/String', 'msg') is String
    assert load_type('std_msgs/String', 'msg') is String


@pytest.mark.parametrize(
    ('name', 'kind', 'message'),
    [
        ('std_msgs/msg/Strin', 'msg', "message type is invalid: 'std_msgs/msg/Strin' is not inst"),
        ('no_msgs/msg/String', 'msg', 'is not installed'),
        ('std_msgs/msg/String', 'srv', 'service type is invalid: .*expected <package>/srv/<name>'),
        ('String', 'action', 'action type is invalid'),
    ],
)
def test_missing_type_is_named(name, kind, message):
    with pytest.raises(CommandError, match=message):
        load_type(name, kind)


def test_list_holds_our_types_and_no_parts_of_services(capsys):
    assert 'hexapod_interfaces/action/TrainRun' in interface_names('action')
    assert main(['interface', 'list', '-s']) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == 'Services:'
    assert '    std_srvs/srv/SetBool' in lines
    assert not any('_Request' in line for line in lines)


# As `ros2 interface show` of ros2interface 0.32.2 prints them.
POINT_STAMPED = """# This represents a Point with reference coordinate frame and timestamp

std_msgs/Header header
\tbuiltin_interfaces/Time stamp
\t\tint32 sec
\t\tuint32 nanosec
\tstring frame_id
Point point
\tfloat64 x
\tfloat64 y
\tfloat64 z
"""
# ros2interface 0.32.2 leaves the mark of a comment that a blank parts from it.
SET_BOOL = """bool data #
---
bool success   #
string message #
"""


def test_definition_with_those_of_its_fields(capsys):
    assert main(['interface', 'show', 'geometry_msgs/msg/PointStamped']) == 0
    assert capsys.readouterr().out == POINT_STAMPED


def test_definition_without_comments(capsys):
    assert main(['interface', 'show', '--no-comments', 'std_srvs/srv/SetBool']) == 0
    assert capsys.readouterr().out == SET_BOOL


@pytest.mark.parametrize(
    ('name', 'message'),
    [
        ('String', "Invalid name 'String'. Expected three parts separated by '/'\n"),
        ('nope/msg/X', "Unknown package 'nope'\n"),
    ],
)
def test_missing_definition(name, message, capsys):
    assert main(['interface', 'show', name]) == 1
    assert capsys.readouterr().err == message
