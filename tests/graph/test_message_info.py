# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Numbers of messages reach a callback, whichever executor serves it."""

from __future__ import annotations

from collections.abc import Callable

import pytest
import rclpy
from hexapod_node.newest import NumberedCallback
from rclpy.context import Context
from rclpy.executors import Executor, SingleThreadedExecutor
from rclpy.experimental.events_executor import EventsExecutor
from rclpy.node import Node
from std_msgs.msg import String

pytestmark = pytest.mark.graph


@pytest.mark.parametrize('executor_type', [EventsExecutor, SingleThreadedExecutor])
def test_each_publisher_has_numbers_of_its_own(executor_type: Callable[..., Executor]) -> None:
    context = Context()
    rclpy.init(context=context)
    node = Node('numbers', context=context)
    executor = executor_type(context=context)
    executor.add_node(node)
    heard: list[tuple[str, int | None]] = []
    callback = NumberedCallback(lambda message, number: heard.append((message.data, number)))
    node.create_subscription(String, 'words', callback, 10)
    first, second = (node.create_publisher(String, 'words', 10) for _ in range(2))
    try:
        while min(p.get_subscription_count() for p in (first, second)) < 1:
            executor.spin_once(timeout_sec=0.05)
        for publisher, word in ((first, 'a'), (first, 'b'), (second, 'c'), (first, 'd')):
            publisher.publish(String(data=word))
        while len(heard) < 4:
            executor.spin_once(timeout_sec=0.05)
    finally:
        executor.shutdown()
        node.destroy_node()
        rclpy.shutdown(context=context)
    assert sorted(heard) == [('a', 1), ('b', 2), ('c', 1), ('d', 3)]


def test_the_workaround_is_needed(graph) -> None:
    """Once this fails, a plain function of two arguments can take NumberedCallback's place."""
    node = graph.nodes[0]
    shapes: list[int] = []
    callback = NumberedCallback(lambda *_: None)
    given = lambda *args: shapes.append(len(args))  # noqa: E731
    given.__signature__ = callback.__signature__  # type: ignore[attr-defined]
    node.create_subscription(String, 'words', given, 10)
    publisher = node.create_publisher(String, 'words', 10)
    graph.until(lambda: publisher.get_subscription_count() == 1)
    publisher.publish(String(data='a'))
    graph.until(lambda: bool(shapes))
    assert shapes == [1]
