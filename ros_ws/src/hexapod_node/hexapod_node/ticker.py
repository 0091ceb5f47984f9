# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Ticks of a node in real time, measured."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.node import Node

from hexapod_node.coroutines import STEADY
from hexapod_node.schedule import Schedule
from hexapod_node.tick_meter import TickMeter

_SECOND_NS = 1_000_000_000
# A timer keeps the phase at which it was made, so it is made again if the moment was missed.
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
        self._period_ns = period_ns
        self._simulated = bool(node.get_parameter('use_sim_time').value)
        self._clock = node.get_clock() if self._simulated else STEADY
        self._phase_ns = phase_ns
        self._tries = 0
        self._await_phase()

    def destroy(self) -> None:
        """Tick no more."""
        self._node.destroy_timer(self._timer)

    def _await_phase(self) -> None:
        """Wait for the moment from which the periodic timer may run."""
        wait_ns = self._period_ns - self._since_phase_ns()
        self._timer = self._node.create_timer(wait_ns / _SECOND_NS, self._begin, clock=STEADY)

    def _since_phase_ns(self) -> int:
        now_ns = self._node.get_clock().now().nanoseconds
        return (now_ns - self._phase_ns) % self._period_ns

    def _begin(self) -> None:
        """Start the periodic timer: its first tick is a period from now."""
        self._node.destroy_timer(self._timer)
        self._tries += 1
        late = self._since_phase_ns() > _PHASE_TOLERANCE_NS
        if late and not self._simulated and self._tries < _PHASE_TRIES:
            self._await_phase()
            return
        now_ns = self._clock.now().nanoseconds
        self._timer = self._node.create_timer(
            self._period_ns / _SECOND_NS, self._on_timer, clock=self._clock
        )
        period_ns = self._timer.timer_period_ns
        # Simulated time has not begun yet, or goes on in leaps: the first tick defines the grid.
        self._schedule = Schedule(period_ns, None if self._simulated else now_ns + period_ns)

    def _on_timer(self) -> None:
        due = self._schedule.serve(self._clock.now().nanoseconds)
        if due is None:
            return
        self.meter.add(due.late_ns, due.missed)
        overdue_ns = due.late_ns - due.missed * self._schedule.period_ns
        stamp_ns = self._node.get_clock().now().nanoseconds - overdue_ns
        try:
            self._callback(Tick(stamp_ns, due.late_ns, due.missed))
        except rclpy_implementation.RCLError:
            if self._node.context.ok():  # else a signal came amid the tick, whose end is no loss
                raise
