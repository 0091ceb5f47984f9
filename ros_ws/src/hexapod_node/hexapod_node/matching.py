# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Makes sure that whoever must hear a topic does, before the first sample is published."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Protocol

from rclpy.node import Node
from rclpy.qos import QoSCompatibility, QoSProfile, qos_check_compatible


class Heard(Protocol):
    """A publisher that tells its topic and how many listen."""

    @property
    def topic_name(self) -> str:
        """Fully qualified name."""

    def get_subscription_count(self) -> int:
        """Return the number of matched subscriptions."""


def unheard(publishers: Iterable[Heard], listeners: Mapping[str, int]) -> str:
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


def listening_nodes(node: Node, topic: str) -> int:
    """Return how many nodes are known to have a subscription that is served by a publisher.

    A number of matched subscriptions does not say whose they are. Where strangers listen too,
    `unheard` is sure of a certain listener only if asked for as many as there are.
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
