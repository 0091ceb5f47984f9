# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Publish the messages of a bag at the pace at which they were recorded."""

import time
from dataclasses import dataclass
from functools import partial

import rclpy
from hexapod_doe.bags.playback import PauseTeller, Playback
from hexapod_doe.bags.selection import Selection
from hexapod_node.raw_topics import message_class, replay_qos
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.time import Time
from rosgraph_msgs.msg import Clock

# How long a sleep may take no notice of a shutdown [ns].
_LONGEST_SLEEP = 100_000_000
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
    """Publishes what was chosen of a bag through a node."""

    def __init__(self, node: Node, selection: Selection, pace: Pace) -> None:
        self._node = node
        self._selection = selection
        self._pace = pace
        bag = selection.bag
        self._begin = bag.start_ns + round(pace.offset * 1e9)
        self._publishers = {
            name: node.create_publisher(
                message_class(bag.types[name]), name, replay_qos(bag.qos[name])
            )
            for name in selection.topics
        }
        clock_qos = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
        self._clock = node.create_publisher(Clock, '/clock', clock_qos) if pace.clock else None
        self._next_tick = 0

    def play(self) -> None:
        """Publish the bag once, or until the context is shut down.

        Raises:
            hexapod_doe.errors.BagError: the bag is damaged further on.
        """
        first = self._begin if self._pace.offset else None
        playback = Playback(
            partial(self._selection.messages, first), self._pace.rate, begin_ns=self._begin
        )
        teller = PauseTeller(playback, self._selection.bag.start_ns, '--start-offset {:.3f}')
        now = self._next_tick = time.monotonic_ns()
        while (wait := playback.wait_ns(now)) is not None and rclpy.ok():
            if notice := teller.notice(wait):
                self._node.get_logger().warning(notice)
            self._tick(playback, now)
            if wait == 0:
                for message in playback.take().messages:
                    self._publishers[message.topic].publish(message.data)
            else:
                self._sleep(wait, now)
            now = time.monotonic_ns()
        for publisher in self._publishers.values():
            publisher.wait_for_all_acked(_ACKNOWLEDGE_TIMEOUT)
        for line in self._selection.skips():
            self._node.get_logger().warning(line)

    def _tick(self, playback: Playback, now: int) -> None:
        """Publish the recorded time if a tick is due."""
        if self._clock is not None and self._next_tick <= now:
            recorded = Time(nanoseconds=playback.recorded_ns(self._next_tick))
            self._clock.publish(Clock(clock=recorded.to_msg()))
            self._next_tick += round(1e9 / self._pace.clock)

    def _sleep(self, wait: int, now: int) -> None:
        """Sleep until the next frame or the next tick, and no longer than a shutdown may take."""
        until_tick = wait if self._clock is None else max(0, self._next_tick - now)
        time.sleep(min(_LONGEST_SLEEP, wait, until_tick) * 1e-9)
