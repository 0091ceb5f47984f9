# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The sensor contract on a live graph: listens to the topics of a set, then checks them."""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from hexapod_node.coroutines import sleep, until_true
from hexapod_node.raw_topics import message_class
from hexapod_node.topic_probe import TopicProbe

from hexapod_agent.contract.check import check_sensors
from hexapod_agent.contract.evidence import Evidence, Offer, TopicEvidence, checked_paths, sample
from hexapod_agent.contract.limits import Limits
from hexapod_agent.contract.report import SensorReport
from hexapod_agent.specification.observation import ObservationSpec

if TYPE_CHECKING:
    from rclpy.node import Node
    from rclpy.topic_endpoint_info import TopicEndpointInfo

# A process may see the others of its domain only after this long.
_DISCOVERY_S = 4.0


async def listen_and_check(
    node: Node,
    spec: ObservationSpec,
    seconds: float,
    limits: Limits | None = None,
    reliable: bool = False,
    discovery_s: float = _DISCOVERY_S,
) -> SensorReport:
    """Listen to the topics of a set and check what came.

    Args:
        node: that listens; its namespace and remappings hold.
        spec: the set.
        seconds: how long to listen.
        limits: tolerances; None for the usual ones.
        reliable: whether the agent will subscribe reliably, as in lock-step.
        discovery_s: longest wait until every topic has brought a first message.
    """
    probe = TopicProbe(
        node,
        {
            topic: message_class(channel.message_type)
            for channel in spec.channels
            for topic in channel.topics
        },
    )
    try:
        await until_true(node, lambda: probe.complete, discovery_s)
        probe.clear()
        await sleep(node, seconds)
        return check_sensors(spec, evidence(spec, probe), limits, reliable)
    finally:  # in the callback of a timer: no subscription goes amid its own
        probe.destroy()


def evidence(spec: ObservationSpec, probe: TopicProbe) -> Evidence:
    """Return what a probe of the set's topics has heard until now."""
    heard = {
        topic: _topic_evidence(
            probe.name(topic),
            probe.publishers(topic),
            [
                sample(message, checked_paths(channel), arrival_ns)
                for arrival_ns, message in probe.messages[topic]
            ],
        )
        for channel in spec.channels
        for topic in channel.topics
    }
    return Evidence(heard, time.monotonic_ns())


def _topic_evidence(
    name: str, publishers: Sequence[TopicEndpointInfo], samples: Sequence[Any]
) -> TopicEvidence:
    offers = tuple(
        Offer(
            publisher=f'{each.node_namespace.rstrip("/")}/{each.node_name}',
            message_type=each.topic_type,
            reliable=each.qos_profile.reliability.name == 'RELIABLE',
        )
        for each in publishers
    )
    return TopicEvidence(name, offers, tuple(samples))
