# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Listens to topics for a while, with the times of arrival, and looks up who publishes them."""

import time
from collections import deque
from collections.abc import Mapping
from functools import partial
from typing import Any

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from rclpy.topic_endpoint_info import TopicEndpointInfo

# Whoever offers more serves this as well, so that a mismatch is seen and not suffered.
PROBE = QoSProfile(
    reliability=ReliabilityPolicy.BEST_EFFORT,
    durability=DurabilityPolicy.VOLATILE,
    history=HistoryPolicy.KEEP_LAST,
    depth=200,
)
# Two minutes at the control rate: a probe that is forgotten does not fill the memory.
_MOST_MESSAGES = 4800


class TopicProbe:
    """The newest messages of some topics, and their publishers.

    Attributes:
        messages: (arrival [ns] on the steady clock, message) by topic as given.
    """

    def __init__(self, node: Node, topics: Mapping[str, type]) -> None:
        self._node = node
        self.messages: dict[str, deque[tuple[int, Any]]] = {
            topic: deque(maxlen=_MOST_MESSAGES) for topic in topics
        }
        self._subscriptions = {
            topic: node.create_subscription(kind, topic, partial(self._on_message, topic), PROBE)
            for topic, kind in topics.items()
        }

    @property
    def complete(self) -> bool:
        """Whether every topic has brought a message."""
        return all(self.messages.values())

    def name(self, topic: str) -> str:
        """Return the topic's fully qualified name, after remapping."""
        return str(self._subscriptions[topic].topic_name)

    def publishers(self, topic: str) -> list[TopicEndpointInfo]:
        """Return the publishers that the graph knows of."""
        return self._node.get_publishers_info_by_topic(self.name(topic))

    def clear(self) -> None:
        """Forget what has come so far."""
        for messages in self.messages.values():
            messages.clear()

    def destroy(self) -> None:
        """Unsubscribe."""
        for subscription in self._subscriptions.values():
            self._node.destroy_subscription(subscription)

    def _on_message(self, topic: str, message: Any) -> None:
        self.messages[topic].append((time.monotonic_ns(), message))
