# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The QoS with which a recorded topic is published again."""

from typing import Any

from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

from ros2_mini.bag.metadata import Topic

_DEFAULT_DEPTH = 10


def replay_profile(topic: Topic) -> QoSProfile:
    """Return the profile that every recorded publisher of a topic could have served.

    A topic without recorded profiles is published reliably, with a history of ten.
    """
    depths = [int(offer.get('depth') or 0) for offer in topic.offers]
    reliable = all(_is(offer, 'reliability', ReliabilityPolicy.RELIABLE) for offer in topic.offers)
    latched = bool(topic.offers) and all(
        _is(offer, 'durability', DurabilityPolicy.TRANSIENT_LOCAL) for offer in topic.offers
    )
    return QoSProfile(
        depth=max([*depths, 0]) or _DEFAULT_DEPTH,
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
    )


def _is(offer: dict[str, Any], policy: str, value: ReliabilityPolicy | DurabilityPolicy) -> bool:
    """Compare a policy that is written by name (format 9) or by number (before)."""
    return offer.get(policy) in (value.short_key, int(value))
