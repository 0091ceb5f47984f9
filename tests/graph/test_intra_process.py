# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Samples within a process go past the middleware, until somebody outside of it listens."""

from __future__ import annotations

import gc
import os
import subprocess
import sys
import weakref

import pytest
import rclpy
from hexapod_node.intra_process import LockStepPublisher, LockStepSubscription, Routes
from hexapod_node.qos import LOCK_STEP
from rclpy.node import Node
from std_msgs.msg import String

pytestmark = pytest.mark.graph

LISTENER = """
import rclpy
from hexapod_node.qos import LOCK_STEP
from std_msgs.msg import String
rclpy.init()
node = rclpy.create_node('outside')
heard = []
node.create_subscription(String, 'topic', heard.append, LOCK_STEP)
while len(heard) < 3:
    rclpy.spin_once(node)
print([message.data for message in heard], flush=True)
"""


class Pair:
    """A publisher, and a subscription of another node of the same process."""

    def __init__(self, graph) -> None:
        self.graph = graph
        self.heard: list[str] = []
        self.talker = graph.add(Node('talker'))
        self.publisher = LockStepPublisher(self.talker, String, 'topic')
        self.listener = graph.add(Node('listener'))
        self.subscription = LockStepSubscription(
            self.listener, String, 'topic', lambda message: self.heard.append(message.data)
        )
        graph.until(lambda: self.publisher.get_subscription_count() == 1)

    def say(self, word: str) -> None:
        self.publisher.publish(String(data=word))


@pytest.fixture
def pair(graph) -> Pair:
    return Pair(graph)


def settle(graph) -> None:
    """Serve whatever else may come."""
    for _ in range(10):
        graph.executor.spin_once(timeout_sec=0.02)


def test_a_sample_is_there_when_publish_returns_and_comes_once(pair: Pair) -> None:
    pair.say('a')
    assert pair.heard == ['a']
    settle(pair.graph)
    assert pair.heard == ['a']


def test_topics_and_contexts_are_kept_apart(pair: Pair) -> None:
    LockStepPublisher(pair.talker, String, 'another').publish(String(data='a'))
    assert pair.heard == []


def test_another_listener_of_the_process_gets_its_samples_as_well(pair: Pair) -> None:
    others: list[str] = []
    pair.listener.create_subscription(
        String, 'topic', lambda message: others.append(message.data), LOCK_STEP
    )
    pair.graph.until(lambda: pair.publisher.get_subscription_count() == 2)
    pair.say('a')
    pair.graph.until(lambda: bool(others and pair.heard))
    settle(pair.graph)
    assert others == pair.heard == ['a']


def test_a_listener_that_nobody_waits_for_is_found(pair: Pair) -> None:
    others: list[str] = []
    pair.say('before')
    pair.listener.create_subscription(
        String, 'topic', lambda message: others.append(message.data), LOCK_STEP
    )

    def heard() -> bool:
        pair.say('a')
        return bool(others)

    pair.graph.until(heard)
    assert set(others) == {'a'}


def test_somebody_outside_misses_nothing_and_nobody_gets_it_twice(pair: Pair) -> None:
    outside = subprocess.Popen(
        [sys.executable, '-c', LISTENER], env=os.environ, stdout=subprocess.PIPE, text=True
    )
    try:
        pair.say('before')
        pair.graph.until(lambda: pair.publisher.get_subscription_count() == 2)
        for word in 'abc':
            pair.say(word)
        pair.graph.until(lambda: len(pair.heard) == 4)
        assert outside.communicate(timeout=20.0)[0] == "['a', 'b', 'c']\n"
    finally:
        outside.kill()
        outside.wait()
    settle(pair.graph)
    assert pair.heard == ['before', 'a', 'b', 'c']


def test_routes_of_several_publishers_stay_until_somebody_comes_or_goes(pair: Pair) -> None:
    unheard = LockStepPublisher(pair.talker, String, 'unheard')
    routes = Routes(pair.talker, {'topic': pair.publisher, 'unheard': unheard})
    opened = routes.open()
    assert list(opened) == ['topic']
    opened['topic'](String(data='a'))
    assert pair.heard == ['a']
    unheard.get_subscription_count()  # has all look again
    assert routes.open() is opened
    LockStepSubscription(pair.listener, String, 'unheard', lambda message: None)
    pair.graph.until(lambda: unheard.get_subscription_count() == 1)
    assert list(routes.open()) == ['topic', 'unheard']
    pair.subscription.destroy()
    assert list(routes.open()) == ['unheard']


def test_who_has_left_hears_nothing(pair: Pair) -> None:
    pair.subscription.destroy()
    pair.say('a')
    settle(pair.graph)
    assert pair.heard == []


def test_who_left_with_its_node_does_not_stand_for_who_came(pair: Pair) -> None:
    pair.graph.executor.remove_node(pair.listener)
    pair.listener.destroy_node()
    pair.graph.until(lambda: pair.publisher.get_subscription_count() == 0)
    came: list[str] = []
    newcomer = pair.graph.add(Node('newcomer'))
    newcomer.create_subscription(
        String, 'topic', lambda message: came.append(message.data), LOCK_STEP
    )
    pair.graph.until(lambda: pair.publisher.get_subscription_count() == 1)
    pair.say('a')
    pair.graph.until(lambda: came == ['a'])
    assert pair.heard == []


def test_a_node_and_its_context_are_freed_when_they_end() -> None:
    def live() -> tuple[weakref.ref, weakref.ref]:
        context = rclpy.Context()
        rclpy.init(context=context)
        node = Node('short', context=context)
        publisher = LockStepPublisher(node, String, 'topic')
        LockStepSubscription(node, String, 'topic', lambda message: None)
        publisher.publish(String(data='a'))
        node.destroy_node()
        rclpy.shutdown(context=context)
        return weakref.ref(node), weakref.ref(context)

    ended = live()
    gc.collect()
    assert [reference() for reference in ended] == [None, None]
