# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Publish the messages of a bag at the pace at which they were recorded."""

import time
from collections.abc import Iterable
from dataclasses import dataclass

import rclpy
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.time import Time
from rosgraph_msgs.msg import Clock

from ros2_mini.bag.messages import RecordedMessage, read_messages
from ros2_mini.bag.metadata import BagMetadata, Topic
from ros2_mini.bag.offers import replay_profile
from ros2_mini.interfaces import load_type

# How long a sleep may take no notice of a shutdown [s].
_LONGEST_SLEEP = 0.1
_ACKNOWLEDGE_TIMEOUT = Duration(seconds=1.0)


@dataclass(frozen=True)
class Pace:
    """How recorded time maps to the time of the replay."""

    rate: float = 1.0
    """Recorded seconds a second."""
    offset: float = 0.0
    """Where in the bag to start [s]."""
    clock: float = 0.0
    """How often to publish the recorded time on `/clock` [Hz]; 0 for not at all."""


class Player:
    """Publishes a bag through a node."""

    def __init__(self, node: Node, bag: BagMetadata, topics: Iterable[Topic], pace: Pace) -> None:
        self._bag = bag
        self._pace = pace
        self._begin = bag.start + round(pace.offset * 1e9)
        self._publishers: dict[str, Publisher] = {
            topic.name: node.create_publisher(
                load_type(topic.type, 'msg'), topic.name, replay_profile(topic)
            )
            for topic in topics
        }
        clock_qos = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
        self._clock = node.create_publisher(Clock, '/clock', clock_qos) if pace.clock else None
        self._next_tick = 0.0

    def play(self) -> None:
        """Publish the bag once, or until the context is shut down."""
        start = time.monotonic()
        self._next_tick = start
        for message in read_messages(self._bag, self._publishers, self._begin):
            self._wait_until(self._due(message, start), start)
            if not rclpy.ok():
                return
            self._publishers[message.topic].publish(message.data)
        for publisher in self._publishers.values():
            publisher.wait_for_all_acked(_ACKNOWLEDGE_TIMEOUT)

    def _due(self, message: RecordedMessage, start: float) -> float:
        return start + (message.time - self._begin) * 1e-9 / self._pace.rate

    def _wait_until(self, due: float, start: float) -> None:
        while rclpy.ok():
            now = time.monotonic()
            if self._clock is not None and self._next_tick <= min(now, due):
                recorded = self._begin + round((self._next_tick - start) * self._pace.rate * 1e9)
                self._clock.publish(Clock(clock=Time(nanoseconds=recorded).to_msg()))
                self._next_tick += 1.0 / self._pace.clock
            elif now >= due:
                return
            else:
                wake = min(due, self._next_tick) if self._clock is not None else due
                time.sleep(min(_LONGEST_SLEEP, max(0.0, wake - now)))
