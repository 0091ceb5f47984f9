# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Makes sure that whoever must hear a topic does, before the first sample is published."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from rclpy.publisher import Publisher


def unheard(publishers: Iterable[Publisher], listeners: Mapping[str, int]) -> str:
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
