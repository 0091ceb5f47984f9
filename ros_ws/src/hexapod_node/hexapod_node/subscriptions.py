# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What a node listens to, as the graph reports it."""

from __future__ import annotations

from rclpy.node import Node

# Every node of rclpy has this one.
_OWN = '/parameter_events'


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
