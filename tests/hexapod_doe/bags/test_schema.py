# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Definitions of installed types are found, ours and others', and say when they are not."""

import pytest
from hexapod_doe.bags.schema import definition, is_stamped, type_hash
from hexapod_doe.errors import BagError
from rosbags.typesys import Stores, get_typestore


def test_dependencies_follow_the_text_depth_first_and_once():
    separator = '=' * 80
    parts = definition('nav_msgs/msg/Odometry').split(f'\n{separator}\n')
    # Odometry: PoseWithCovariance (Pose (Point, Quaternion)), TwistWithCovariance (Twist
    # (Vector3)), Header (Time), each set in alphabetic order, as rosbag2 writes them.
    assert [part.splitlines()[0] for part in parts[1:]] == [
        f'MSG: {name}'
        for name in (
            'geometry_msgs/PoseWithCovariance',
            'geometry_msgs/Pose',
            'geometry_msgs/Point',
            'geometry_msgs/Quaternion',
            'geometry_msgs/TwistWithCovariance',
            'geometry_msgs/Twist',
            'geometry_msgs/Vector3',
            'std_msgs/Header',
            'builtin_interfaces/Time',
        )
    ]


def test_hash_equals_that_of_an_independent_library():
    store = get_typestore(Stores.ROS2_JAZZY)
    for name in ('sensor_msgs/msg/Imu', 'sensor_msgs/msg/JointState', 'rosgraph_msgs/msg/Clock'):
        assert type_hash(name) == store.hash_rihs01(name)


def test_own_types_are_found():
    assert 'episode_return' in definition('hexapod_interfaces/msg/EpisodeResult')
    assert type_hash('hexapod_interfaces/msg/EpisodeResult').startswith('RIHS01_')


@pytest.mark.parametrize(
    ('name', 'stamped'),
    [
        ('sensor_msgs/msg/Imu', True),
        ('rosgraph_msgs/msg/Clock', True),
        ('hexapod_interfaces/msg/CpgState', True),
        ('std_msgs/msg/String', False),
        ('geometry_msgs/msg/Twist', False),
    ],
)
def test_stamped_types(name, stamped):
    assert is_stamped(name) is stamped


@pytest.mark.parametrize(
    ('name', 'reason'),
    [
        ('nowhere_msgs/msg/Thing', "package 'nowhere_msgs' is not in AMENT_PREFIX_PATH"),
        ('std_msgs/msg/Thing', r'no .*Thing\.msg, expected an installed definition'),
        ('String', 'expected <package>/msg/<Type>'),
    ],
)
def test_unknown_type(name, reason):
    with pytest.raises(BagError, match=f"message type '{name}': {reason}"):
        definition(name)
