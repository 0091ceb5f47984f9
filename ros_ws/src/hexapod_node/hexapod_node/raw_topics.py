# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Subscribes to any topics of the graph for their serialised messages, whoever publishes them."""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from importlib import import_module
from typing import Protocol

from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from rclpy.subscription import Subscription
from rclpy.topic_endpoint_info import TopicEndpointInfo

from hexapod_node.qos import LOCK_STEP


def message_class(type_name: str) -> type:
    """Return the class of a message type such as 'sensor_msgs/msg/Imu'.

    Raises:
        ValueError: no such type is installed.
    """
    package, _, name = type_name.partition('/msg/')
    try:
        return getattr(import_module(f'{package}.msg'), name)
    except (ImportError, AttributeError, TypeError, ValueError) as error:
        raise ValueError(
            f"message type '{type_name}': not installed, expected <package>/msg/<Type> of a "
            'package in the environment'
        ) from error


class Offered(Protocol):
    """What a recorded publisher offered, policies by their names in rmw."""

    @property
    def reliability(self) -> str:
        """Such as 'reliable'."""

    @property
    def durability(self) -> str:
        """Such as 'transient_local'."""


def replay_qos(offered: Sequence[Offered]) -> QoSProfile:
    """Offer what every recorded publisher offered, and keep all of it until it is read."""
    reliable = all(profile.reliability == 'reliable' for profile in offered)
    latched = bool(offered) and all(p.durability == 'transient_local' for p in offered)
    return QoSProfile(
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
        history=HistoryPolicy.KEEP_ALL,
    )


def subscribe_raw(
    node: Node, topic: str, type_name: str, callback: Callable[[bytes], None], qos: QoSProfile
) -> Subscription:
    """Subscribe for the bytes as they came over the wire, which also saves decoding them."""
    return node.create_subscription(
        message_class(type_name),
        topic,
        callback,
        qos,
        raw=True,
        event_callbacks=SubscriptionEventCallbacks(use_default_callbacks=False),
    )


class RawSubscriptions:
    """Subscriptions to topics of which only the names are known beforehand."""

    def __init__(self, node: Node, callback: Callable[[str, bytes], None]) -> None:
        """Begin with none.

        Args:
            node: that subscribes.
            callback: called with topic and message.
        """
        self._node = node
        self._callback = callback
        self._subscriptions: list[Subscription] = []

    @property
    def topics(self) -> list[str]:
        """Names of what is subscribed, fully qualified."""
        return [subscription.topic_name for subscription in self._subscriptions]

    def open(self, topics: Mapping[str, Sequence[TopicEndpointInfo]]) -> None:
        """Subscribe to topics, as their publishers offer them.

        Args:
            topics: publishers by name of their topic, at least one each.
        """
        self._subscriptions = [
            subscribe_raw(
                self._node,
                name,
                publishers[0].topic_type,
                partial(self._callback, name),
                matching_qos(publishers),
            )
            for name, publishers in topics.items()
        ]

    def unmatched(self) -> list[str]:
        """Return the topics without a publisher that this node hears."""
        return [s.topic_name for s in self._subscriptions if not s.get_publisher_count()]

    def close(self) -> None:
        """Unsubscribe."""
        for subscription in self._subscriptions:
            self._node.destroy_subscription(subscription)
        self._subscriptions = []


def matching_qos(publishers: Sequence[TopicEndpointInfo]) -> QoSProfile:
    """Return the strictest profile that every publisher of a topic can serve."""
    offered = [publisher.qos_profile for publisher in publishers]
    reliable = all(qos.reliability is ReliabilityPolicy.RELIABLE for qos in offered)
    latched = all(qos.durability is DurabilityPolicy.TRANSIENT_LOCAL for qos in offered)
    return QoSProfile(
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=(DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE),
        history=LOCK_STEP.history,
        depth=LOCK_STEP.depth,
    )
