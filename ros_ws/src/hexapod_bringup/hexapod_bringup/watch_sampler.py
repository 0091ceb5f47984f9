# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Hears topics of robots without a callback for each message."""

from collections.abc import Iterator
from typing import Any

from hexapod_interfaces.msg import StepOutcome
from hexapod_node.node import Node
from hexapod_node.qos import DRIVER
from hexapod_node.raw_topics import message_class
from nav_msgs.msg import Odometry
from rclpy.qos import QoSProfile
from rclpy.subscription import Subscription

from hexapod_bringup.watching.board import ODOMETRY, OUTCOME
from hexapod_bringup.watching.signals import SIGNALS

_QUEUED = 100  # samples of a topic: 2.5 s of simulated time
_QUEUE = QoSProfile(
    reliability=DRIVER.reliability,
    durability=DRIVER.durability,
    history=DRIVER.history,
    depth=_QUEUED,
)
TRUTH = {OUTCOME: StepOutcome, ODOMETRY: Odometry}
_TYPES = {topic: message_class(s.channel.message_type) for topic, s in SIGNALS.items()} | TRUTH


class Sampler(Node):
    """Holds subscriptions that no executor serves: their samples wait to be taken."""

    def __init__(self) -> None:
        super().__init__('watch_sampler')
        self._open: dict[tuple[str, str], Subscription] = {}

    def hear(self, wanted: set[tuple[str, str]]) -> None:
        """Subscribe to these topics of these robots, and to nothing else."""
        for gone in self._open.keys() - wanted:
            self.destroy_subscription(self._open.pop(gone))
        for robot, topic in wanted - self._open.keys():
            self._open[robot, topic] = self.create_subscription(
                _TYPES[topic], joined(robot, topic), lambda _: None, _QUEUE
            )

    def take(self) -> Iterator[tuple[str, str, list[Any]]]:
        """Yield robot, topic and messages that have come since, oldest first."""
        for (robot, topic), subscription in self._open.items():
            if messages := list(_taken(subscription)):
                yield robot, topic, messages

    @property
    def count(self) -> int:
        """Number of subscriptions."""
        return len(self._open)


def _taken(subscription: Subscription) -> Iterator[Any]:
    with subscription.handle:
        for _ in range(_QUEUED):
            taken = subscription.handle.take_message(subscription.msg_type, False)
            if taken is None:
                return
            yield taken[0]


def joined(robot: str, topic: str) -> str:
    """Return the relative name of a robot's topic."""
    return f'{robot}/{topic}' if robot else topic
