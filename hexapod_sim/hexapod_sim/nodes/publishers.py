# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What the sim publishes of a task: sensors, the outcome, the truth and the clock."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from hexapod_interfaces.msg import StepOutcome
from hexapod_node.intra_process import LockStepPublisher, Publish, Routes
from hexapod_node.stamps import time_message
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock

from hexapod_sim.channel import Channel
from hexapod_sim.nodes.messages import (
    SENSOR_TOPICS,
    SensorTopic,
    fill_odometry,
    fill_outcome,
    new_odometry,
)
from hexapod_sim.task import LineTask, Outcome

if TYPE_CHECKING:
    from rclpy.node import Node

OUTCOME, ODOMETRY, CLOCK = 'step_outcome', 'odom', 'clock'


class SimPublishers:
    """Publishes samples of a task; what nobody hears is neither read nor sent.

    The publishers are reliable, which best-effort subscriptions match as well.
    """

    def __init__(self, node: Node, task: LineTask) -> None:
        self._task = task
        self._messages = {topic.name: topic.new() for topic in SENSOR_TOPICS}
        self._odometry, self._outcome = new_odometry(), StepOutcome()
        types = {topic.name: topic.message_type for topic in SENSOR_TOPICS}
        # Relative: in the root namespace this is /clock, and workers side by side do not clash.
        types |= {OUTCOME: StepOutcome, ODOMETRY: Odometry, CLOCK: Clock}
        publishers = {name: LockStepPublisher(node, kind, name) for name, kind in types.items()}
        self.all = list(publishers.values())
        self._routes = Routes(node, publishers)
        self._open: Mapping[str, Publish] = {}
        self._heard: list[SensorTopic] = []
        self._channels: list[Channel] = []

    def publish(self, outcome: Outcome, now_ns: int) -> None:
        """Publish the sample of now: sensors first, then what they earned, then the clock."""
        self._look()
        stamp, publish = time_message(now_ns), self._open
        readings = {row.key: self._task.sensors.read(row) for row in self._channels}
        for topic in self._heard:
            message = self._messages[topic.name]
            message.header.stamp = stamp
            topic.fill(message, readings[topic.channel.key])
            publish[topic.name](message)
        if ODOMETRY in publish:
            fill_odometry(self._odometry, self._task.simulation)
            self._odometry.header.stamp = stamp
            publish[ODOMETRY](self._odometry)
        if OUTCOME in publish:
            fill_outcome(self._outcome, outcome)
            self._outcome.header.stamp = stamp
            publish[OUTCOME](self._outcome)
        if CLOCK in publish:
            publish[CLOCK](Clock(clock=stamp))

    def _look(self) -> None:
        """Find out what somebody hears, where that may have changed."""
        if (routes := self._routes.open()) is self._open:
            return
        self._open = routes
        self._heard = [topic for topic in SENSOR_TOPICS if topic.name in routes]
        channels = {topic.channel.key: topic.channel for topic in self._heard}
        self._channels = list(channels.values())
