# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Who subscribes to what, as the graph reports it, and whether all are there who must be."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Protocol

from rclpy.node import Node
from rclpy.qos import QoSCompatibility, QoSProfile, qos_check_compatible

# Every node of rclpy has this one.
_OWN = '/parameter_events'


class SubscriptionCounter(Protocol):
    """A publisher that tells its topic and how many listen."""

    @property
    def topic_name(self) -> str:
        """Fully qualified name."""

    def get_subscription_count(self) -> int:
        """Return the number of matched subscriptions."""


def unmatched(publishers: Iterable[SubscriptionCounter], listeners: Mapping[str, int]) -> str:
    """Say which of these publishers has fewer subscriptions than it must have, or ''.

    Args:
        publishers: What this node publishes.
        listeners: Least number of matched subscriptions by fully qualified topic; topics that
            are not published here do not matter.
    """
    matched = {
        publisher.topic_name: publisher.get_subscription_count() for publisher in publishers
    }
    for topic, least in listeners.items():
        if matched.get(topic, least) < least:
            return f'{topic} has {matched[topic]} of {least} subscriptions'
    return ''


def listeners_of(topics: Sequence[str], subscriptions: Sequence[int]) -> dict[str, int]:
    """Return the least number of subscriptions by topic, as a request for a reset lists them.

    Raises:
        ValueError: the lists are of unequal length.
    """
    if len(topics) != len(subscriptions):
        raise ValueError(
            f'topics and subscriptions: {len(topics)} and {len(subscriptions)} entries, expected '
            'as many of each'
        )
    return dict(zip(topics, subscriptions, strict=True))


def count_subscriber_nodes(node: Node, topic: str) -> int:
    """Return how many nodes are known to have a subscription that is served by a publisher.

    A number of matched subscriptions does not say whose they are. Where strangers listen too,
    `unmatched` is sure of a certain listener only if asked for as many as there are.
    Nodes are counted by name, as one that was killed is known for some time beside its successor.
    """
    offers = [publisher.qos_profile for publisher in node.get_publishers_info_by_topic(topic)]
    return len(
        {
            (listener.node_namespace, listener.node_name)
            for listener in node.get_subscriptions_info_by_topic(topic)
            if any(_served(offered, listener.qos_profile) for offered in offers)
        }
    )


def _served(offered: QoSProfile, requested: QoSProfile) -> bool:
    return qos_check_compatible(offered, requested)[0] != QoSCompatibility.ERROR


def subscribed_topics(observer: Node, name: str, namespace: str) -> list[str]:
    """Return the topics that a node subscribes to, from the endpoints that DDS has discovered.

    Args:
        observer: Any node of the same domain.
        name: The node's name.
        namespace: Its namespace, such as `/worker_1`.
    """
    return sorted(
        topic
        for topic, _ in observer.get_topic_names_and_types()
        if topic != _OWN
        and any(
            (endpoint.node_name, endpoint.node_namespace) == (name, namespace)
            for endpoint in observer.get_subscriptions_info_by_topic(topic)
        )
    )
