# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Hands lock-step samples to the other nodes of the same process, past the middleware.

rclcpp does so for composed nodes; rclpy does not. Every endpoint is on the ROS graph as ever, and
a topic that somebody outside of the process listens to goes through the middleware, to everybody.
"""

from __future__ import annotations

import functools
from collections import defaultdict
from collections.abc import Callable, Sequence
from typing import Any
from weakref import WeakKeyDictionary

from rclpy.context import Context
from rclpy.exceptions import InvalidHandle
from rclpy.node import Node

from hexapod_node.qos import LOCK_STEP

Publish = Callable[[Any], None]

_subscriptions: WeakKeyDictionary[Context, defaultdict[str, list[LockStepSubscription]]]
_subscriptions = WeakKeyDictionary()


def _of_process(node: Node, topic: str) -> list[LockStepSubscription]:
    """Return the subscriptions of a topic that the context's nodes have, to read or to change."""
    return _subscriptions.setdefault(node.context, defaultdict(list))[topic]


class LockStepSubscription:
    """A subscription whose callback also gets what is published in the same process.

    It is then called within the publisher's call, with the publisher's own message: what it keeps
    of that message must not be needed after the next sample.
    """

    def __init__(self, node: Node, kind: type, topic: str, callback: Publish) -> None:
        self.callback = callback
        self._node = node
        self._subscription = node.create_subscription(kind, topic, callback, LOCK_STEP)
        self.topic_name: str = self._subscription.topic_name
        _of_process(node, self.topic_name).append(self)

    def destroy(self) -> None:
        """Unsubscribe."""
        _of_process(self._node, self.topic_name).remove(self)
        self._node.destroy_subscription(self._subscription)

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
        self._neighbours = _of_process(node, self.topic_name)

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
        matched = [each for each in self._neighbours if each.is_matched()]
        if len(matched) < listeners:
            return self._publisher.publish
        if len(matched) == 1:
            return matched[0].callback
        return functools.partial(_call, matched)

    def publish(self, message: Any) -> None:
        """Publish a sample."""
        if (publish := self.route()) is not None:
            publish(message)
