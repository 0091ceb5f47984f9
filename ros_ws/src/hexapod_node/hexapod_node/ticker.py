# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Ticks of a node in real time, measured."""

import time
from collections.abc import Callable
from dataclasses import dataclass

from rclpy.clock import JumpThreshold
from rclpy.duration import Duration
from rclpy.node import Node

from hexapod_node.tick_meter import TickMeter
from hexapod_node.timers import Timer, call_every, call_soon
from hexapod_node.upstream import RCLError

_ANY_MOVE = JumpThreshold(
    min_forward=Duration(nanoseconds=1), min_backward=Duration(nanoseconds=-1)
)
_SECOND_NS = 1_000_000_000
_PHASE_TOLERANCE_NS = 1_000_000
_PHASE_TRIES = 40


@dataclass(frozen=True)
class Due:
    """The first tick that was not served yet.

    Attributes:
        late_ns: How long ago it was due.
        missed: Further ticks that were due since.
    """

    late_ns: int
    missed: int


class Schedule:
    """Ticks on a grid that never drifts, whenever they are served."""

    def __init__(self, period_ns: int, first_ns: int | None = None) -> None:
        """Begin before the first tick.

        Args:
            period_ns: Time between two ticks.
            first_ns: When the first one is due; None for whenever it is served.
        """
        self.period_ns = period_ns
        self._next_ns = first_ns

    def serve(self, now_ns: int) -> Due | None:
        """Return what is due now and expect the tick after it; None for nothing.

        A clock that jumped back by more than a period begins a new grid.
        """
        due_ns = self._next_ns
        if due_ns is None or now_ns < due_ns - 2 * self.period_ns:
            due_ns = now_ns
        if now_ns < due_ns:
            return None
        late_ns = now_ns - due_ns
        missed = late_ns // self.period_ns
        self._next_ns = due_ns + (missed + 1) * self.period_ns
        return Due(late_ns, missed)


class SimulatedTime:
    """The steps of /clock, as a node with `use_sim_time` hears them.

    Steps that come while the last one has yet to be served are one.
    """

    def __init__(self, node: Node, callback: Callable[[], object]) -> None:
        """Begin to listen.

        Args:
            node: whose clock it is, and whose executor calls.
            callback: called after each step.
        """
        self._node = node
        self._callback = callback
        self._posted = self._cancelled = False
        self._jumps = node.get_clock().create_jump_callback(_ANY_MOVE, post_callback=self._on_jump)

    def cancel(self) -> None:
        """Listen no more."""
        self._cancelled = True
        self._jumps.unregister()

    def _on_jump(self, _: object) -> None:
        """Leave the middleware's call, which every clock of the process waits for."""
        if not self._posted:
            self._posted = True
            call_soon(self._node, self._serve)

    def _serve(self) -> None:
        self._posted = False
        if not self._cancelled:
            self._callback()


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
