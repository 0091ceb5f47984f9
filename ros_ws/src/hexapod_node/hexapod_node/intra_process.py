# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Hands lock-step samples to the other nodes of the same process, past the middleware.

rclcpp does so for composed nodes; rclpy does not. Every endpoint is on the ROS graph as ever, and
a topic that somebody outside of the process listens to goes through the middleware, to everybody.

To ask the middleware who listens takes as long as to hand a sample over. A publisher asks when
somebody waits for listeners, when one of its process comes or goes, and every few milliseconds.
"""

import functools
import itertools
import math
import time
from collections import defaultdict
from collections.abc import Callable, Sequence
from typing import Any
from weakref import WeakKeyDictionary, WeakValueDictionary

from rclpy.context import Context
from rclpy.exceptions import InvalidHandle
from rclpy.node import Node

from hexapod_node.qos import LOCK_STEP

Publish = Callable[[Any], None]

_LOOK_AGAIN_S = 0.01  # a listener from elsewhere that nobody waits for is served so late at most


class _Neighbours:
    """The subscriptions of one topic that the nodes of a context have.

    Attributes:
        by_number: In the order of their making; nothing here may keep a node alive.
        changes: How often one came or was destroyed.
    """

    def __init__(self) -> None:
        self.by_number: WeakValueDictionary[int, LockStepSubscription] = WeakValueDictionary()
        self.changes = 0


_neighbours: WeakKeyDictionary[Context, defaultdict[str, _Neighbours]] = WeakKeyDictionary()
_numbers = itertools.count()


def _neighbours_at(node: Node, topic: str) -> _Neighbours:
    return _neighbours.setdefault(node.context, defaultdict(_Neighbours))[topic]


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
        neighbours = _neighbours_at(node, self.topic_name)
        neighbours.by_number[self._number] = self
        neighbours.changes += 1

    def destroy(self) -> None:
        """Unsubscribe."""
        neighbours = _neighbours_at(self._node, self.topic_name)
        neighbours.by_number.pop(self._number)
        neighbours.changes += 1
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
        self._neighbours = _neighbours_at(node, self.topic_name)
        self._route: Publish | None = None
        self._looked_s = -math.inf
        self._changes_seen = 0

    def get_subscription_count(self) -> int:
        """Return the number of matched subscriptions, in this process or in any other.

        All of them get the next sample: who waits until its listeners are there may rely on it.
        """
        self._looked_s = -math.inf
        return int(self._publisher.get_subscription_count())

    def route(self) -> Publish | None:
        """Return what publishes a sample to whoever listens; None if nobody does.

        The message may be used again for the next sample.
        """
        now_s, changes = time.monotonic(), self._neighbours.changes
        if now_s - self._looked_s > _LOOK_AGAIN_S or changes != self._changes_seen:
            self._route = self._look()
            self._looked_s, self._changes_seen = now_s, changes
        return self._route

    def _look(self) -> Publish | None:
        """Find the route to those who listen now."""
        listeners = self._publisher.get_subscription_count()
        if not listeners:
            return None
        matched = [each for each in self._neighbours.by_number.values() if each.is_matched()]
        if len(matched) < listeners:
            return self._publisher.publish
        if len(matched) == 1:
            return matched[0].callback
        return functools.partial(_call, matched)

    def publish(self, message: Any) -> None:
        """Publish a sample."""
        if (publish := self.route()) is not None:
            publish(message)
