# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Subscribes to topics and hands out whole control periods, as soon as each is complete."""

import time
from collections.abc import Mapping
from functools import partial
from typing import Any

from rclpy.node import Node
from rclpy.task import Future

from hexapod_node.coroutines import pause, until
from hexapod_node.intra_process import LockStepSubscription
from hexapod_node.stamp_gate import LockStepCounts, StampGate
from hexapod_node.stamps import to_nanoseconds
from hexapod_node.timers import call_every

_WATCH_PERIOD_S = 0.5
# Control periods after which the executor has a turn, where nobody has to be waited for: a turn
# takes as long as handing out a period.
_PERIODS_A_TURN = 8


class LockStepTimeoutError(TimeoutError):
    """A topic did not deliver its sample of the period in time."""


class LockStep:
    """The topics of one run, subscribed for as long as this object lives.

    Every message has a header whose stamp is the start of its control period.
    """

    def __init__(
        self, node: Node, topics: Mapping[str, type], period_ns: int, timeout_s: float
    ) -> None:
        self._node = node
        self._timeout_s = timeout_s
        self._gate = StampGate(topics, period_ns)
        self._arrival: Future | None = None
        self._waiting_since = 0.0
        self._since_turn = 0
        self._subscriptions = [
            LockStepSubscription(node, kind, topic, partial(self._on_message, topic))
            for topic, kind in topics.items()
        ]
        self._watch = call_every(node, _WATCH_PERIOD_S, self._on_watch)

    @property
    def counts(self) -> LockStepCounts:
        """Departures from lock-step so far."""
        return self._gate.counts

    @property
    def topics(self) -> list[str]:
        """Fully qualified names of what is subscribed."""
        return [subscription.topic_name for subscription in self._subscriptions]

    def stop(self) -> None:
        """Keep what comes from here on for the next `start`."""
        self._gate.stop()

    def start(self, stamp_ns: int) -> None:
        """Expect the period that begins at the stamp."""
        self._gate.start(stamp_ns)

    async def next_period(self) -> dict[str, Any]:
        """Return the messages of the next period, by topic.

        Raises:
            LockStepTimeoutError: a topic stayed silent; the text names it and its stamp.
        """
        self._since_turn += 1
        if not self._gate.complete:
            self._since_turn = 0
            self._arrival = Future()
            self._waiting_since = time.monotonic()
            await until(self._arrival)
        elif self._since_turn >= _PERIODS_A_TURN:
            self._since_turn = 0
            await pause(self._node)  # nodes of this process answer at once; others have a turn
        return self._gate.take()

    def destroy(self) -> None:
        """Unsubscribe."""
        self._watch.cancel()
        for subscription in self._subscriptions:
            subscription.destroy()

    def _on_message(self, topic: str, message: Any) -> None:
        complete = self._gate.offer(topic, to_nanoseconds(message.header.stamp), message)
        if complete and self._arrival is not None:
            arrival, self._arrival = self._arrival, None
            arrival.set_result(None)

    def _on_watch(self) -> None:
        if self._arrival is None or time.monotonic() - self._waiting_since < self._timeout_s:
            return
        absent = self._gate.absent()
        self._gate.counts.missing += len(absent)
        arrival, self._arrival = self._arrival, None
        seconds = (self._gate.expected_ns or 0) * 1e-9
        arrival.set_exception(
            LockStepTimeoutError(
                f'no sample of {", ".join(absent)} stamped {seconds:.3f} s came within '
                f'{self._timeout_s:g} s: expected one per control period from a running publisher'
            )
        )
