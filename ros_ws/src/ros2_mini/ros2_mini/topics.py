# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Look up the topics of the graph and their types."""

import rclpy
from rclpy.exceptions import InvalidTopicNameException
from rclpy.expand_topic_name import expand_topic_name
from rclpy.node import Node
from rclpy.topic_or_service_is_hidden import topic_or_service_is_hidden
from rclpy.validate_full_topic_name import validate_full_topic_name

from ros2_mini.discovery import wait_for
from ros2_mini.errors import CommandError


def topic_names_and_types(node: Node, *, hidden: bool = False) -> list[tuple[str, list[str]]]:
    """Return the topics of the graph with their types, sorted by name."""
    return sorted(
        (name, types)
        for name, types in node.get_topic_names_and_types()
        if hidden or not topic_or_service_is_hidden(name)
    )


def expanded(node: Node, topic: str) -> str:
    """Return the absolute name of a topic.

    Raises:
        CommandError: If that is no valid name.
    """
    try:
        name = expand_topic_name(topic, node.get_name(), node.get_namespace())
        validate_full_topic_name(name)
    except (ValueError, InvalidTopicNameException) as error:
        raise CommandError(' '.join(str(error).split())) from error
    return name


def topic_type(node: Node, topic: str, limit: float) -> str | None:
    """Return the name of a topic's type; None if the topic has not appeared within `limit` s.

    Raises:
        CommandError: If the topic has more than one type.
    """
    name = expanded(node, topic)

    def look() -> list[str]:
        return dict(node.get_topic_names_and_types()).get(name, []) if rclpy.ok() else []

    types = wait_for(look, limit)
    if len(types) > 1:
        raise CommandError(
            f"Cannot use topic '{topic}', as it contains more than one type: [{', '.join(types)}]"
        )
    return types[0] if types else None
