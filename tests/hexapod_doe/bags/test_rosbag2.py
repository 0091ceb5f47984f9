# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The layout is that of rosbag2, old and new."""

from pathlib import Path

import pytest
import yaml
from hexapod_doe.bags.rosbag2 import (
    Extent,
    OfferedQos,
    Topic,
    information,
    is_unfinished,
    offered_qos,
)

# As rosbag2 of ROS 2 Humble wrote it: policies are the numbers of rmw/types.h.
HUMBLE = """
- history: 3
  depth: 0
  reliability: 2
  durability: 1
  deadline: {sec: 9223372036, nsec: 854775807}
  lifespan: {sec: 9223372036, nsec: 854775807}
  liveliness: 1
  liveliness_lease_duration: {sec: 1, nsec: 5}
  avoid_ros_namespace_conventions: false
"""


def test_profiles_of_old_bags_are_understood():
    assert offered_qos(HUMBLE) == (
        OfferedQos(
            reliability='best_effort',
            durability='transient_local',
            history='unknown',
            depth=0,
            liveliness_lease_ns=1_000_000_005,
        ),
    )
    assert offered_qos('') == ()


def test_profiles_survive_a_round_trip():
    profile = OfferedQos(durability='transient_local', depth=1, deadline_ns=25_000_000)
    assert offered_qos([profile.as_dict()]) == (profile,)
    # rosbag2 spells "no limit" as the largest int64.
    assert profile.as_dict()['lifespan'] == {'sec': 9223372036, 'nsec': 854775807}


def test_extent_spans_the_messages_whatever_their_order():
    extent = Extent({'/a': 0, '/b': 0})
    for topic, time_ns in (('/a', 50), ('/b', 20), ('/a', 90)):
        extent.add(topic, time_ns)
    assert extent == Extent({'/a': 2, '/b': 1}, messages=3, start_ns=20, end_ns=90)
    listed = information('x_0.mcap', [Topic('/a', 'std_msgs/msg/Header')], extent)
    assert listed['starting_time'] == {'nanoseconds_since_epoch': 20}
    assert listed['duration'] == {'nanoseconds': 70}
    assert yaml.safe_load(yaml.safe_dump(listed)) == listed


@pytest.mark.parametrize(
    ('name', 'unfinished'),
    [
        ('r1', False),
        ('r1.partial', True),
        ('r1.cut_12', True),
        ('r1.salvaged', True),
        ('r1.cut_', False),
        ('partial', False),
    ],
)
def test_names_of_unfinished_bags(name, unfinished):
    assert is_unfinished(Path('/campaign') / name) is unfinished
