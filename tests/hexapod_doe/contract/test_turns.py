# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Two publishers in a bag are told from one that was started anew."""

from __future__ import annotations

from array import array
from pathlib import Path

import pytest
from hexapod_agent.specification.observation import ObservationSpec
from hexapod_doe.bags.bag_writer import BagWriter
from hexapod_doe.bags.rosbag2 import OfferedQos, Topic
from hexapod_doe.contract.bag_evidence import bag_evidence
from hexapod_sim.robot import JOINTS
from rclpy.serialization import serialize_message
from sensor_msgs.msg import JointState

PERIOD_NS = 25_000_000
SENT = 40


def joints(stamp_ns: int, prefix: str = '') -> bytes:
    values = array('d', [0.0] * 18)
    message = JointState(name=[prefix + name for name in JOINTS], position=values, velocity=values)
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp_ns, 1_000_000_000)
    return serialize_message(message)


def publishers(folder: Path, messages: list[bytes], profiles: int) -> int:
    """Return how many publishers of a recorded topic are seen."""
    with BagWriter(folder / 'b', {}) as writer:
        topic = Topic('/joint_states', 'sensor_msgs/msg/JointState', (OfferedQos(),) * profiles)
        writer.add_topic(topic)
        for index, message in enumerate(messages):
            writer.write('/joint_states', message, index * PERIOD_NS // 2)
    heard = bag_evidence(folder / 'b', ObservationSpec(''), {}).topics['joint_states']
    return len(heard.offers)


@pytest.mark.parametrize('profiles', [1, 2])
def test_names_that_alternate_are_of_two(tmp_path: Path, profiles: int) -> None:
    messages = [joints(k * PERIOD_NS, ('', 'px/')[k % 2]) for k in range(SENT)]
    assert publishers(tmp_path, messages, profiles) == 2


def test_a_driver_that_was_started_anew_is_one(tmp_path: Path) -> None:
    prefixes = ['', 'px/', '']
    messages = [joints(k * PERIOD_NS, prefixes[k * 3 // SENT]) for k in range(SENT)]
    assert publishers(tmp_path, messages, profiles=3) == 1


@pytest.mark.parametrize(('profiles', 'seen'), [(1, 1), (2, 2)])
def test_stamps_that_repeat_are_of_two_where_two_were_recorded(
    tmp_path: Path, profiles: int, seen: int
) -> None:
    """A single publisher that repeats its stamps is at fault itself."""
    messages = [joints(k // 2 * PERIOD_NS) for k in range(SENT)]
    assert publishers(tmp_path, messages, profiles) == seen
