# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Two definitions are the same type if the same bytes mean the same numbers, and not else."""

from __future__ import annotations

import pytest
from hexapod_doe.bags.definition import departure, is_unproven, layout
from hexapod_doe.bags.mcap_file import RecordedTopic
from hexapod_doe.bags.schema import definition, type_hash

POINT = 'geometry_msgs/msg/Point'
STAMPED = """# a point with its header
std_msgs/Header header   # when
Point point
float32[<=3] few
uint8 LEFT=1
string NAME = "a # b"
string<=8[] names
int32 count -7
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: geometry_msgs/msg/Point
float64 x
float64 y
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"""


def recorded(type_name: str, text: str = '', language: str = 'ros2msg') -> RecordedTopic:
    return RecordedTopic('/t', type_name, 'cdr', text.encode(), language, '')


def test_the_layout_is_what_goes_over_the_wire() -> None:
    assert layout('geometry_msgs/msg/PointStamped', STAMPED) == {
        'geometry_msgs/PointStamped': (
            'std_msgs/Header header',
            'geometry_msgs/Point point',
            'float32[<=3] few',
            'string<=8[] names',
            'int32 count',
        ),
        'std_msgs/Header': ('builtin_interfaces/Time stamp', 'string frame_id'),
        'geometry_msgs/Point': ('float64 x', 'float64 y'),
        'builtin_interfaces/Time': ('int32 sec', 'uint32 nanosec'),
    }


@pytest.mark.parametrize(
    'type_name',
    [
        'sensor_msgs/msg/Imu', 'sensor_msgs/msg/PointCloud2',
        'trajectory_msgs/msg/JointTrajectory',
        'diagnostic_msgs/msg/DiagnosticArray', 'std_msgs/msg/Empty', 'nav_msgs/msg/Odometry',
        'hexapod_interfaces/msg/EpisodeResult',
    ],
)  # fmt: skip
def test_an_installed_type_is_itself_whatever_its_comments(type_name: str) -> None:
    text = definition(type_name)
    assert departure(recorded(type_name, text), type_hash(type_name)) == ''
    bare = '\r\n'.join(line.split('#')[0].rstrip() for line in text.splitlines())
    assert departure(recorded(type_name, bare), '') == ''


@pytest.mark.parametrize(
    ('change', 'reason'),
    [
        (
            ('float64 z', ''),
            "geometry_msgs/Point has no further field in the bag, 'float64 z' here",
        ),
        (('float64 y', 'float32 y'), "has 'float32 y' in the bag, 'float64 y' here"),
        (
            ('float64 z', 'float64 z\nfloat64 w'),
            "has 'float64 w' in the bag, no further field here",
        ),
        (('float64 x', 'float64 longitude'), "has 'float64 longitude' in the bag"),
        (('float64 x', '{"x": 1}'), 'its definition cannot be read'),
        (('float64 x', 'Scalar x'), 'no definition of geometry_msgs/Scalar'),
    ],
)
def test_another_definition_is_named_by_its_first_difference(
    change: tuple[str, str], reason: str
) -> None:
    text = definition(POINT).replace(*change)
    assert reason in departure(recorded(POINT, text), '')


def test_a_part_of_a_part_counts() -> None:
    """Twenty years on, the seconds of a stamp have 64 bits."""
    text = definition('sensor_msgs/msg/Imu').replace('int32 sec', 'int64 sec')
    found = departure(recorded('sensor_msgs/msg/Imu', text), '')
    assert found.startswith("builtin_interfaces/Time has 'int64 sec' in the bag")


def test_the_hash_decides_where_the_text_cannot() -> None:
    own, other = type_hash(POINT), type_hash('geometry_msgs/msg/Vector3')
    idl = recorded(POINT, 'module geometry_msgs {', 'ros2idl')
    assert departure(idl, own) == ''
    assert 'another hash' in departure(idl, other)
    assert "its definition is in 'ros2idl', expected ros2msg" in departure(idl, '')
    assert 'another hash' in departure(recorded(POINT, definition(POINT)), other)


def test_nothing_but_a_name_proves_nothing() -> None:
    bare, zeros = recorded(POINT), 'RIHS01_' + 64 * '0'
    assert departure(bare, '') == ''
    assert is_unproven(bare, '')
    assert not is_unproven(recorded('std_msgs/msg/Empty'), '')
    assert is_unproven(bare, zeros)
    assert not is_unproven(bare, type_hash(POINT))
    assert not is_unproven(recorded(POINT, definition(POINT)), '')


@pytest.mark.parametrize('name', ['no_msgs/msg/Such', 'sensor_msgs/msg/Such', 'odd', ''])
def test_a_type_that_is_not_installed_is_named(name: str) -> None:
    assert departure(recorded(name, 'int8 x'), '').endswith('is not installed')


def test_a_text_that_is_none_and_other_encodings_are_refused() -> None:
    odd = replace_text(recorded(POINT), b'\xff\xfe')
    assert 'its definition cannot be read' in departure(odd, '')
    json = recorded(POINT, definition(POINT))._replace(encoding='json')
    assert departure(json, '') == "its messages are in 'json', expected cdr"


def replace_text(topic: RecordedTopic, text: bytes) -> RecordedTopic:
    return topic._replace(definition=text)
