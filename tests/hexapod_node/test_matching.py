# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Who must hear a topic, told from who else listens to it."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator

import pytest
import rclpy
from hexapod_node.matching import count_subscriber_nodes, unmatched
from hexapod_node.qos import LOCK_STEP
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String

pytestmark = pytest.mark.graph
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


@pytest.fixture
def node() -> Iterator[Callable[[str], Node]]:
    """Return a function that makes nodes, which end with the test."""
    rclpy.init()
    made: list[Node] = []

    def make(name: str) -> Node:
        made.append(rclpy.create_node(name))
        return made[-1]

    yield make
    for each in made:
        each.destroy_node()
    rclpy.shutdown()


def until(predicate: Callable[[], bool]) -> None:
    deadline = time.monotonic() + 10.0
    while not predicate():
        assert time.monotonic() < deadline
        time.sleep(0.01)


def listen(node: Node, qos: QoSProfile = LOCK_STEP) -> None:
    node.create_subscription(String, 'topic', lambda message: None, qos)


def test_a_topic_is_unheard_until_enough_are_matched(node) -> None:
    publisher = node('talker').create_publisher(String, 'topic', LOCK_STEP)
    assert unmatched([publisher], {'/topic': 1}) == '/topic has 0 of 1 subscriptions'
    assert unmatched([publisher], {'/another': 1}) == ''
    listen(node('sim'))
    until(lambda: unmatched([publisher], {'/topic': 1}) == '')
    assert unmatched([publisher], {'/topic': 2}) == '/topic has 1 of 2 subscriptions'


def test_listeners_are_nodes_and_only_those_that_get_the_samples(node) -> None:
    asking = node('agent')
    node('talker').create_publisher(String, 'topic', LOCK_STEP)
    assert count_subscriber_nodes(asking, '/topic') == 0
    listen(node('sim'))
    listen(node('onlooker'))
    until(lambda: count_subscriber_nodes(asking, '/topic') == 2)
    # What wants the samples of the past gets none from a publisher that does not keep them.
    listen(node('late'), LATCHED)
    until(lambda: asking.count_subscribers('/topic') == 3)
    assert count_subscriber_nodes(asking, '/topic') == 2


def test_a_node_that_was_started_again_counts_once(node) -> None:
    asking = node('agent')
    asking.create_publisher(String, 'topic', LOCK_STEP)
    for _ in range(2):  # of the same name, as its killed predecessor is known for a while
        listen(node('sim'))
    until(lambda: asking.count_subscribers('/topic') == 2)
    assert count_subscriber_nodes(asking, '/topic') == 1
