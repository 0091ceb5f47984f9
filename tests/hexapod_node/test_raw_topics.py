# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A recorded topic is offered again as every one of its publishers could have served it."""

from __future__ import annotations

from types import SimpleNamespace

import pytest
from hexapod_node.raw_topics import message_class, replay_qos
from rclpy.qos import DurabilityPolicy, HistoryPolicy, ReliabilityPolicy
from sensor_msgs.msg import Imu

RELIABLE, LATCHED, LOSSY = (
    SimpleNamespace(reliability=reliability, durability=durability)
    for reliability, durability in (
        ('reliable', 'volatile'),
        ('reliable', 'transient_local'),
        ('best_effort', 'volatile'),
    )
)


@pytest.mark.parametrize(
    ('offered', 'reliable', 'latched'),
    [
        ([], True, False),
        ([RELIABLE], True, False),
        ([LATCHED], True, True),
        ([LATCHED, RELIABLE], True, False),
        ([RELIABLE, LOSSY], False, False),
    ],
)
def test_topic_is_offered_as_it_was(offered: list, reliable: bool, latched: bool) -> None:
    profile = replay_qos(offered)
    assert (profile.reliability is ReliabilityPolicy.RELIABLE) == reliable
    assert (profile.durability is DurabilityPolicy.TRANSIENT_LOCAL) == latched
    assert profile.history is HistoryPolicy.KEEP_ALL


def test_class_of_a_type_is_found_by_its_name() -> None:
    assert message_class('sensor_msgs/msg/Imu') is Imu
    for name in ('no_msgs/msg/Such', 'std_srvs/srv/SetBool_Event', 'Imu', ''):
        with pytest.raises(ValueError, match='not installed'):
            message_class(name)
