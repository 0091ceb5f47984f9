# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Hands lock-step samples to the other nodes of the same process, past the middleware.

rclcpp does so for composed nodes; rclpy does not. Every endpoint is on the ROS graph as ever, and
a topic that somebody outside of the process listens to goes through the middleware, to everybody.
"""

from __future__ import annotations

import functools
import itertools
from collections import defaultdict
from collections.abc import Callable, Sequence
from typing import Any
from weakref import WeakKeyDictionary, WeakValueDictionary

from rclpy.context import Context
from rclpy.exceptions import InvalidHandle
from rclpy.node import Node

from hexapod_node.qos import LOCK_STEP

Publish = Callable[[Any], None]

# By number, in the order of their making. Nothing here may keep a node or its context alive.
_Neighbours = WeakValueDictionary[int, 'LockStepSubscription']
_subscriptions: WeakKeyDictionary[Context, defaultdict[str, _Neighbours]] = WeakKeyDictionary()
_numbers = itertools.count()


def _neighbours(node: Node, topic: str) -> _Neighbours:
    """Return the subscriptions of a topic that the context's nodes have, to read or to change."""
    return _subscriptions.setdefault(node.context, defaultdict(WeakValueDictionary))[topic]


class LockStepSubscription:
    """A subscription whose callback also gets what is published in the same process.

    It is then called within the publisher's call, with the publisher's own message: what it keeps
    of that message must not be needed after the next sample.
    """

    def __init__(self, node: Node, kind: type, topic: str, callback: Publish) -> None:
        self.callback = callback
        self._node = node
        # The bound method lets it live as long as the node has the subscription.
        self._subscription = node.create_subscription(kind, topic, self._on_message, LOCK_STEP)
        self.topic_name: str = self._subscription.topic_name
        self._number = next(_numbers)
        _neighbours(node, self.topic_name)[self._number] = self

    def destroy(self) -> None:
        """Unsubscribe."""
        _neighbours(self._node, self.topic_name).pop(self._number)
        self._node.destroy_subscription(self._subscription)

    def _on_message(self, message: Any) -> None:
        self.callback(message)

    def is_matched(self) -> bool:
        """Return whether it has a publisher; not so once its node is destroyed."""
        try:
            return bool(self._subscription.get_publisher_count())
        except InvalidHandle:
            return False


def _call(subscriptions: Sequence[LockStepSubscription], message: Any) -> None:
    for each in subscriptions:
        each.callback(message)


class LockStepPublisher:
    """A publisher that calls the subscriptions of its process where nobody else listens."""

    def __init__(self, node: Node, kind: type, topic: str) -> None:
        self._publisher = node.create_publisher(kind, topic, LOCK_STEP)
        self.topic_name: str = self._publisher.topic_name
        self._neighbours = _neighbours(node, self.topic_name)

    def get_subscription_count(self) -> int:
        """Return the number of matched subscriptions, in this process or in any other."""
        return int(self._publisher.get_subscription_count())

    def route(self) -> Publish | None:
        """Return what publishes a sample to whoever listens now; None if nobody does.

        The message may be used again for the next sample.
        """
        listeners = self.get_subscription_count()
        if not listeners:
            return None
        matched = [each for each in self._neighbours.values() if each.is_matched()]
        if len(matched) < listeners:
            return self._publisher.publish
        if len(matched) == 1:
            return matched[0].callback
        return functools.partial(_call, matched)

    def publish(self, message: Any) -> None:
        """Publish a sample."""
        if (publish := self.route()) is not None:
            publish(message)
