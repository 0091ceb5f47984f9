# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Node `player`: plays a bag with MCAP storage, byte for byte, with its clock."""

import time
from collections.abc import Sequence
from functools import partial
from typing import Any

from diagnostic_msgs.msg import DiagnosticStatus
from hexapod_node.diagnostics import Diagnostics, Health
from hexapod_node.node import Node
from hexapod_node.parameters import Parameter, declare
from hexapod_node.raw_topics import message_class, replay_qos
from hexapod_node.spin import run
from hexapod_node.stamps import time_message
from hexapod_node.timers import Timer, call_later
from rclpy.duration import Duration
from rclpy.parameter import Parameter as RclpyParameter
from rosgraph_msgs.msg import Clock
from std_srvs.srv import Trigger

from hexapod_doe.bags.bag_file import BagFile
from hexapod_doe.bags.playback import Frame, PauseTeller, Playback
from hexapod_doe.bags.selection import Selection, select
from hexapod_doe.errors import BagError

CLOCK_TOPIC = '/clock'
CLOCK_TYPE = 'rosgraph_msgs/msg/Clock'
# Longest that the end of playback waits until its readers have everything.
_DRAIN = Duration(seconds=5)

PARAMETERS = (
    Parameter('bag', '', 'Directory of the bag, or one .mcap file.'),
    Parameter(
        'rate', 1.0, 'Recorded seconds per second; 0 for as fast as possible.', range=(0.0, 1e6)
    ),
    Parameter('loop', False, 'Begin again at the end; /clock then jumps back.'),
    Parameter(
        'start', 0.0, 'Where to begin, from the first message.', unit='s', range=(0.0, 1e10)
    ),
    Parameter('paused', False, 'Hold before the first message.'),
    Parameter(
        'delay', 0.0, 'Time for subscribers to find the player in.', unit='s', range=(0.0, 1e6)
    ),
    Parameter('clock', True, "Publish /clock, in place of the bag's own."),
    Parameter(
        'topics', '', 'Names to play, or their ends, separated by spaces; none for all of them.'
    ),
)


class PlayerNode(Node):
    """Publishes a bag's messages when they are due, and `/clock` after those of each instant.

    Then a `/clock` in the bag is left out: there is one clock, the player's. So is, with a
    warning, a topic of a type that is not installed, or that was recorded by another definition
    than the installed one: its subscribers would read wrong numbers.
    """

    def __init__(self, parameter_overrides: Sequence[RclpyParameter] = ()) -> None:
        """Open the bag.

        Args:
            parameter_overrides: values that stand in for the command line's.

        Raises:
            BagError: it cannot be played; the text says why.
        """
        super().__init__('player', parameter_overrides=list(parameter_overrides))
        declare(self, PARAMETERS)
        self.exit_status: int | None = None
        if not self._value('bag'):
            raise BagError("parameter 'bag' is not set, expected a bag: -p bag:=DIR")
        self._bag = BagFile(str(self._value('bag')))
        self._selection = self._selected()
        for line in self._selection.warnings():
            self.get_logger().warning(line)
        has_clock = bool(self._value('clock'))
        self._clock_publisher = (
            self.create_publisher(Clock, CLOCK_TOPIC, 10) if has_clock else None
        )
        self._bag_publishers = {
            name: self.create_publisher(
                message_class(self._bag.types[name]), name, replay_qos(self._bag.qos[name])
            )
            for name in self._selection.topics
        }
        self._playback = Playback(
            partial(self._selection.messages, self._start_ns()),
            rate=float(self._value('rate')),
            loop=bool(self._value('loop')),
            paused=bool(self._value('paused')),
        )
        if self._playback.finished:
            raise BagError(self._nothing())
        self._played = 0
        self._pauses = PauseTeller(self._playback, self._bag.start_ns)
        self._now_ns = self._bag.start_ns
        self.create_service(Trigger, '~/pause', self._on_pause)
        self.create_service(Trigger, '~/resume', self._on_resume)
        self.create_service(Trigger, '~/step', self._on_step)
        self._timer: Timer = call_later(self, float(self._value('delay')), self._on_due)
        Diagnostics(self, self._health)

    def _value(self, name: str) -> Any:
        return self.get_parameter(name).value

    def _selected(self) -> Selection:
        """Return the topics to play.

        Raises:
            BagError: one of those asked for is not there, or none can be played.
        """
        names = str(self._value('topics')).split() or list(self._bag.types)
        chosen = [self._bag.topic(name) for name in names]
        if self._value('clock'):
            chosen = [name for name in chosen if self._bag.types[name] != CLOCK_TYPE]
        return select(self._bag, chosen, message_class)

    def _start_ns(self) -> int | None:
        """Return the recorded time to begin at; None for the first message, whatever its time."""
        after_ns = round(float(self._value('start')) * 1e9)
        return self._bag.start_ns + after_ns if after_ns else None

    def _nothing(self) -> str:
        """Return why there is no message to play."""
        name = f'bag {self._bag.path}'
        if self._start_ns() is None or not self._bag.about.message_count:
            return f'{name}: empty, expected a message to play'
        lasts = self._bag.about.duration_ns * 1e-9
        return (
            f'{name}: no message from start:={self._value("start")} s on, it lasts {lasts:.3f} s'
        )

    def _on_due(self) -> None:
        """Publish what is due, then sleep until the next is; a damaged bag ends it."""
        self._timer.cancel()
        wait_ns = self._playback.wait_ns(time.monotonic_ns())
        if wait_ns == 0:
            try:
                self._publish(self._playback.take())
            except BagError as error:
                self.get_logger().error(f'{error}; {self._played} messages were played')
                self.exit_status = 1
                return
            wait_ns = self._playback.wait_ns(time.monotonic_ns())
        if notice := self._pauses.notice(wait_ns):
            self.get_logger().warning(notice)
        if wait_ns is not None:
            self._timer = call_later(self, wait_ns * 1e-9, self._on_due)

    def _publish(self, frame: Frame) -> None:
        for message in frame.messages:
            self._bag_publishers[message.topic].publish(message.data)
        if self._clock_publisher is not None:
            self._clock_publisher.publish(Clock(clock=time_message(frame.time_ns)))
        self._played += len(frame.messages)
        self._now_ns = frame.time_ns
        if self._playback.finished:
            for publisher in self._bag_publishers.values():
                publisher.wait_for_all_acked(_DRAIN)
            for line in self._selection.skips():
                self.get_logger().warning(line)
            self.get_logger().info(f'played {self._played} messages of {self._bag.path}')
            self.exit_status = 0

    def _health(self) -> Health:
        values = {
            'bag': self._bag.path,
            'messages': self._played,
            'seconds': f'{(self._now_ns - self._bag.start_ns) * 1e-9:.3f}',
        }
        state = 'paused' if self._playback.paused else 'playing'
        refused, skipped = self._selection.refused, self._selection.skipped
        if not refused and not skipped:
            return DiagnosticStatus.OK, state, values
        values |= {f'not played: {topic}': reason for topic, reason in refused.items()}
        values |= {f'not CDR: {topic}': count for topic, count in skipped.items()}
        return DiagnosticStatus.WARN, f'{state} a part of the bag', values

    def _on_pause(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        """Hold before the next instant."""
        self._playback.pause(time.monotonic_ns())
        response.success = True
        return response

    def _on_resume(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        """Go on from where it was held."""
        self._playback.resume()
        self._on_due()
        response.success = True
        return response

    def _on_step(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        """Publish all messages of the next instant, while paused."""
        try:
            frame = self._playback.step()
        except ValueError as error:
            response.message = str(error)
            return response
        self._publish(frame)
        response.success = True
        response.message = f'{frame.time_ns * 1e-9:.9f} s, {len(frame.messages)} messages'
        return response


def main() -> None:
    """Run the node until the bag ends or a signal comes."""
    run(PlayerNode)


if __name__ == '__main__':
    main()
