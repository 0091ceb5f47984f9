# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Describes a topic of the graph as a bag lists it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from hexapod_doe.bags.rosbag2 import OfferedQos, Topic
from hexapod_doe.errors import BagError

if TYPE_CHECKING:
    from rclpy.qos import QoSProfile
    from rclpy.topic_endpoint_info import TopicEndpointInfo


def recorded_topic(name: str, publishers: list[TopicEndpointInfo]) -> Topic:
    """Describe a topic as its publishers offer it.

    Raises:
        BagError: they publish different types.
    """
    types = sorted({publisher.topic_type for publisher in publishers})
    if len(types) != 1:
        raise BagError(f'topic {name}: types {", ".join(types) or "unknown"}, expected one')
    return Topic(
        name, types[0], tuple(_offered(publisher.qos_profile) for publisher in publishers)
    )


def _offered(qos: QoSProfile) -> OfferedQos:
    return OfferedQos(
        reliability=qos.reliability.name.lower(),
        durability=qos.durability.name.lower(),
        history=qos.history.name.lower(),
        depth=qos.depth,
        liveliness=qos.liveliness.name.lower(),
        deadline_ns=qos.deadline.nanoseconds,
        lifespan_ns=qos.lifespan.nanoseconds,
        liveliness_lease_ns=qos.liveliness_lease_duration.nanoseconds,
    )
