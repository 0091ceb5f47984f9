# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Ticks of a node in real time, measured."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

from rclpy.node import Node

from hexapod_node.schedule import Schedule
from hexapod_node.simulated_time import SimulatedTime
from hexapod_node.tick_meter import TickMeter
from hexapod_node.timers import Timer, call_every
from hexapod_node.upstream import RCLError

_SECOND_NS = 1_000_000_000
_PHASE_TOLERANCE_NS = 1_000_000
_PHASE_TRIES = 40


@dataclass(frozen=True)
class Tick:
    """One call of a ticker.

    Attributes:
        stamp_ns: When the tick was due, on the node's clock; never a period ago.
        late_ns: How long ago the first tick was due that was not served yet.
        missed: Ticks that were due before this one and are left out.
    """

    stamp_ns: int
    late_ns: int
    missed: int


class Ticker:
    """Calls back once per period, on the steady clock or on simulated time.

    On the steady clock the ticks lie at a phase of the node's clock: nodes of one machine, or of
    machines whose clocks agree, keep their order within every period.

    Attributes:
        meter: Lateness of the ticks.
    """

    def __init__(
        self,
        node: Node,
        period_ns: int,
        callback: Callable[[Tick], None],
        phase_ns: int = 0,
    ) -> None:
        """Begin to tick.

        Args:
            node: whose executor serves the ticks.
            period_ns: time between two ticks.
            callback: called at each tick.
            phase_ns: when to tick, from whole multiples of the period on the node's clock.
        """
        self.meter = TickMeter()
        self._node = node
        self._callback = callback
        if node.get_parameter('use_sim_time').value:
            self._now_ns = lambda: node.get_clock().now().nanoseconds
            # Simulated time has not begun yet, or goes on in leaps: the first tick is the grid.
            self._schedule = Schedule(period_ns)
            self._source: Timer | SimulatedTime = SimulatedTime(node, self._on_time)
        else:
            self._now_ns = time.monotonic_ns
            first_ns = _next_phase_ns(node, period_ns, phase_ns)
            self._schedule = Schedule(period_ns, first_ns)
            self._source = call_every(node, period_ns / _SECOND_NS, self._on_time, first_ns)

    def destroy(self) -> None:
        """Tick no more."""
        self._source.cancel()

    def _on_time(self) -> None:
        due = self._schedule.serve(self._now_ns())
        if due is None:
            return
        self.meter.add(due.late_ns, due.missed)
        overdue_ns = due.late_ns - due.missed * self._schedule.period_ns
        stamp_ns = self._node.get_clock().now().nanoseconds - overdue_ns
        try:
            self._callback(Tick(stamp_ns, due.late_ns, due.missed))
        except RCLError:
            if self._node.context.ok():  # else a signal came amid the tick, whose end is no loss
                raise


def _next_phase_ns(node: Node, period_ns: int, phase_ns: int) -> int:
    """Return the next moment of the phase, on `time.monotonic_ns`."""
    for _ in range(_PHASE_TRIES):
        before_ns = time.monotonic_ns()
        clock_ns = node.get_clock().now().nanoseconds
        after_ns = time.monotonic_ns()
        if after_ns - before_ns <= _PHASE_TOLERANCE_NS:  # else the process paused in between
            break
    return after_ns + period_ns - (clock_ns - phase_ns) % period_ns
