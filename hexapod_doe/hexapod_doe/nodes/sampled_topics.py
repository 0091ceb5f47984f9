# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What the recorder hears of a sampled episode: every topic of the run, while it lasts."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from hexapod_node.coroutines import until_true
from hexapod_node.raw_topics import RawSubscriptions

from hexapod_doe.bags.recording import Recording
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


if TYPE_CHECKING:
    from rclpy.node import Node


class SampledTopics:
    """Subscriptions to a run's topics, only while an episode is sampled.

    At any other time nobody publishes them for nothing.

    Attributes:
        names: Fully qualified topics of the run.
    """

    def __init__(self, node: Node, on_sample: Callable[[str, bytes], None]) -> None:
        """Begin with none.

        Args:
            node: that subscribes; its parameters `match_timeout` and `drain_timeout` are the
                longest waits, s.
            on_sample: called with topic and message.
        """
        self._node = node
        self._subscriptions = RawSubscriptions(node, on_sample)
        self.names: list[str] = []

    @property
    def subscribed(self) -> list[str]:
        """Fully qualified topics that are subscribed now."""
        return self._subscriptions.topics

    async def begin(self, recording: Recording, episode: int) -> None:
        """Subscribe, and return once every topic is heard.

        Raises:
            BagError: a topic has no publisher, or none of compatible QoS; the text names it.
        """
        node, timeout_s = self._node, self._seconds('match_timeout')
        self.close()
        if not await until_true(node, lambda: not self._unpublished(), timeout_s):
            raise BagError(
                f'episode {episode}: no publisher of {", ".join(self._unpublished())} within '
                f'{timeout_s:g} s, expected one of each recorded topic'
            )
        publishers = {name: node.get_publishers_info_by_topic(name) for name in self.names}
        recording.begin_sample(
            episode, [recorded_topic(name, publishers[name]) for name in publishers]
        )
        self._subscriptions.open(publishers)
        if not await until_true(node, lambda: not self._subscriptions.unmatched(), timeout_s):
            unmatched = ', '.join(self._subscriptions.unmatched())
            raise BagError(
                f'episode {episode}: {unmatched} not heard within {timeout_s:g} s, expected a '
                'publisher of compatible QoS'
            )

    async def end(self, recording: Recording, last_ns: int) -> list[str]:
        """Unsubscribe once the samples of the episode's last period are there, or do not come.

        Returns:
            The departures from one sample of every topic per period, a line each.
        """
        await until_true(
            self._node, lambda: not recording.waiting(last_ns), self._seconds('drain_timeout')
        )
        self.close()
        return recording.end_sample(last_ns)

    def close(self) -> None:
        """Unsubscribe."""
        self._subscriptions.close()

    def _unpublished(self) -> list[str]:
        return [name for name in self.names if not self._node.count_publishers(name)]

    def _seconds(self, parameter: str) -> float:
        return float(self._node.get_parameter(parameter).value)
