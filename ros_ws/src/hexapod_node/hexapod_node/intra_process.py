# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Hands lock-step samples to the other nodes of the same process, past the middleware.

rclcpp does so for composed nodes; rclpy does not. Every endpoint is on the ROS graph as ever, and
a topic that somebody outside of the process listens to goes through the middleware, to everybody.

To ask the middleware who listens takes as long as to hand a sample over. Publishers ask when
somebody waits for listeners, when one of their process comes or goes, and every few milliseconds.
"""

import functools
import itertools
import math
import time
from collections import defaultdict
from collections.abc import Callable, Mapping, Sequence
from typing import Any
from weakref import WeakKeyDictionary, WeakValueDictionary

from rclpy.context import Context
from rclpy.exceptions import InvalidHandle
from rclpy.node import Node

from hexapod_node.qos import LOCK_STEP

Publish = Callable[[Any], None]

_LOOK_AGAIN_S = 0.01  # a listener from elsewhere that nobody waits for is served so late at most


class _Neighbours:
    """The subscriptions that the nodes of a context have.

    Attributes:
        by_topic: By number, in the order of their making; nothing here may keep a node alive.
    """

    def __init__(self) -> None:
        self.by_topic: defaultdict[str, WeakValueDictionary[int, LockStepSubscription]] = (
            defaultdict(WeakValueDictionary)
        )
        self._changes = 0
        self._looked_s = -math.inf

    def change(self) -> None:
        """Have every publisher look again who listens, before its next sample."""
        self._changes += 1

    def changes(self) -> int:
        """Return a number that stays the same for as long as nobody needs to look again."""
        now_s = time.monotonic()
        if now_s - self._looked_s > _LOOK_AGAIN_S:
            self._looked_s = now_s
            self._changes += 1
        return self._changes


_neighbours: WeakKeyDictionary[Context, _Neighbours] = WeakKeyDictionary()
_numbers = itertools.count()


def _neighbours_of(node: Node) -> _Neighbours:
    return _neighbours.setdefault(node.context, _Neighbours())


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
        neighbours = _neighbours_of(node)
        neighbours.by_topic[self.topic_name][self._number] = self
        neighbours.change()

    def destroy(self) -> None:
        """Unsubscribe."""
        neighbours = _neighbours_of(self._node)
        neighbours.by_topic[self.topic_name].pop(self._number)
        neighbours.change()
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
        self._neighbours = _neighbours_of(node)
        self._route: Publish | None = None
        self._changes_seen = 0

    def get_subscription_count(self) -> int:
        """Return the number of matched subscriptions, in this process or in any other.

        All of them get the next sample: who waits until its listeners are there may rely on it.
        """
        self._neighbours.change()
        return int(self._publisher.get_subscription_count())

    def route(self) -> Publish | None:
        """Return what publishes a sample to whoever listens; None if nobody does.

        The message may be used again for the next sample.
        """
        changes = self._neighbours.changes()
        if changes != self._changes_seen:
            self._route = self._look()
            self._changes_seen = changes
        return self._route

    def _look(self) -> Publish | None:
        """Find the route to those who listen now."""
        listeners = self._publisher.get_subscription_count()
        if not listeners:
            return None
        neighbours = self._neighbours.by_topic[self.topic_name]
        matched = [each for each in neighbours.values() if each.is_matched()]
        if len(matched) < listeners:
            return self._publisher.publish
        if len(matched) == 1:
            return matched[0].callback
        return functools.partial(_call, matched)

    def publish(self, message: Any) -> None:
        """Publish a sample."""
        if (publish := self.route()) is not None:
            publish(message)


class Routes:
    """The routes of several publishers, by their names, looked for together."""

    def __init__(self, node: Node, publishers: Mapping[str, LockStepPublisher]) -> None:
        self._neighbours = _neighbours_of(node)
        self._publishers = publishers
        self._routes: dict[str, Publish] = {}
        self._changes_seen = 0

    def open(self) -> Mapping[str, Publish]:
        """Return `LockStepPublisher.route` of those that somebody listens to.

        It is the same object as before where nobody came or went.
        """
        changes = self._neighbours.changes()
        if changes != self._changes_seen:
            self._changes_seen = changes
            found = {key: each.route() for key, each in self._publishers.items()}
            routes = {key: route for key, route in found.items() if route is not None}
            if routes != self._routes:
                self._routes = routes
        return self._routes
