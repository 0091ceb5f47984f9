# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What the sim publishes of a task: sensors, the outcome, the truth and the clock."""

from __future__ import annotations

from array import array
from typing import TYPE_CHECKING

from builtin_interfaces.msg import Time
from hexapod_interfaces.msg import StepOutcome
from hexapod_node.intra_process import LockStepPublisher
from hexapod_node.stamps import time_message
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock

from hexapod_sim.nodes.messages import SENSOR_TOPICS, fill_odometry, new_odometry
from hexapod_sim.task import LineTask, Outcome

if TYPE_CHECKING:
    from rclpy.node import Node


class SimPublishers:
    """Publishes samples of a task; what nobody hears is neither read nor sent.

    The publishers are reliable, which best-effort subscriptions match as well.
    """

    def __init__(self, node: Node, task: LineTask) -> None:
        self._task = task
        self._sensors = [
            (
                sensor,
                sensor.new(),
                LockStepPublisher(node, sensor.message_type, sensor.name),
            )
            for sensor in SENSOR_TOPICS
        ]
        self._outcome = StepOutcome()
        self._outcome_publisher = LockStepPublisher(node, StepOutcome, 'step_outcome')
        self._odometry = new_odometry()
        self._odometry_publisher = LockStepPublisher(node, Odometry, 'odom')
        # Relative: in the root namespace this is /clock, and workers side by side do not clash.
        self._clock_publisher = LockStepPublisher(node, Clock, 'clock')
        self.all: list[LockStepPublisher] = [
            *(publisher for _, _, publisher in self._sensors),
            self._outcome_publisher,
            self._odometry_publisher,
            self._clock_publisher,
        ]

    def publish(self, outcome: Outcome, now_ns: int) -> None:
        """Publish the sample of now: sensors first, then what they earned, then the clock."""
        stamp = time_message(now_ns)
        routes = [(*entry, publisher.route()) for *entry, publisher in self._sensors]
        heard = [(sensor, message, publish) for sensor, message, publish in routes if publish]
        channels = {sensor.channel.key: sensor.channel for sensor, _, _ in heard}
        readings = {key: self._task.sensors.read(row) for key, row in channels.items()}
        for sensor, message, publish in heard:
            message.header.stamp = stamp
            sensor.fill(message, readings[sensor.channel.key])
            publish(message)
        if publish := self._odometry_publisher.route():
            fill_odometry(self._odometry, self._task.simulation)
            self._odometry.header.stamp = stamp
            publish(self._odometry)
        self._publish_outcome(outcome, stamp)
        if publish := self._clock_publisher.route():
            publish(Clock(clock=stamp))

    def _publish_outcome(self, outcome: Outcome, stamp: Time) -> None:
        message = self._outcome
        message.header.stamp = stamp
        message.step = outcome.step
        message.reward = outcome.reward
        message.term_names = list(outcome.terms)
        message.term_values = array('d', outcome.terms.values())
        message.terminated = outcome.terminated
        message.truncated = outcome.truncated
        message.cause = outcome.cause
        self._outcome_publisher.publish(message)
