# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Everything that a node does later or again: one thread says when, the node's executor does it.

It stands in for the timers of rclpy, which do not survive a pause of the process under
EventsExecutor: see docs/upstream.md, whose test in tests/hexapod_node/test_upstream.py fails once
they do. No node of this project makes a timer of rclpy.
"""

import heapq
import itertools
import threading
import time
from collections import deque
from collections.abc import Callable
from weakref import ReferenceType, ref

from rclpy.node import Node

from hexapod_node import progress

Callback = Callable[[], object]
_SECOND_NS = 1_000_000_000
# A node that nobody serves yet is looked at again so soon.
_UNSERVED_NS = 10_000_000
_LONGEST_WAIT_S = 3600.0

_failures: deque[BaseException] = deque()


class Timer:
    """A call that is due at a moment of the steady clock, once or periodically.

    A periodic call keeps to its grid. What was due while the process stood still is served once:
    a call is due again only after it has been served, so that none can pile up.
    """

    def __init__(
        self, node: Node, callback: Callback, due_ns: int, period_ns: int | None = None
    ) -> None:
        """Begin to wait.

        Args:
            node: whose executor calls; None of its own is needed yet.
            callback: what to call.
            due_ns: when, on `time.monotonic_ns`.
            period_ns: time between two calls; None for one call.
        """
        self._node: ReferenceType[Node] = ref(node)
        self._callback: Callback | None = callback
        self._due_ns = due_ns
        self._period_ns = period_ns
        _timers_of(node).add(self)
        self._wait()

    def cancel(self) -> None:
        """Call no more."""
        self._callback = None
        node = self._node()
        if node is not None:
            _timers_of(node).discard(self)

    def _wait(self) -> None:
        if self._due_ns > time.monotonic_ns():
            _alarm.add(self._due_ns, self)
        else:
            self.ring()

    def ring(self) -> None:
        """Hand the call to the node's executor, or wait for one; any thread may do so."""
        node = self._node()
        if node is None or self._callback is None:
            return
        executor = node.executor
        if executor is None:
            _alarm.add(time.monotonic_ns() + _UNSERVED_NS, self)
        else:
            # An executor that ends keeps the tasks that it has not served: none may keep a node.
            executor.create_task(_serve, ref(self))

    def serve(self) -> None:
        """Make the call; called by the executor."""
        callback = self._callback
        if callback is None:
            return
        if self._period_ns is None:
            self.cancel()
        else:
            late_ns = max(time.monotonic_ns() - self._due_ns, 0)
            self._due_ns += (late_ns // self._period_ns + 1) * self._period_ns
            self._wait()
        callback()


def _serve(timer: ReferenceType[Timer]) -> None:
    """Serve a timer that is still wanted, and keep what it raises: a task must not raise."""
    progress.served()
    wanted = timer()
    if wanted is not None:
        try:
            wanted.serve()
        except BaseException as error:
            _failures.append(error)


def call_later(node: Node, seconds: float, callback: Callback) -> Timer:
    """Have a node's executor call once, so many seconds from now on the steady clock."""
    return Timer(node, callback, time.monotonic_ns() + int(seconds * _SECOND_NS))


def call_every(
    node: Node, period_s: float, callback: Callback, first_ns: int | None = None
) -> Timer:
    """Have a node's executor call periodically.

    Args:
        node: that calls.
        period_s: time between two calls.
        callback: what to call.
        first_ns: when to begin, on `time.monotonic_ns`; None for a period from now.
    """
    period_ns = round(period_s * _SECOND_NS)
    due_ns = time.monotonic_ns() + period_ns if first_ns is None else first_ns
    return Timer(node, callback, due_ns, period_ns)


def call_soon(node: Node, callback: Callback) -> None:
    """Have a node's executor call after what else is due; any thread may ask for it."""
    Timer(node, callback, 0)


def cancel_all(node: Node) -> None:
    """Have a node that ends call nothing any more."""
    for timer in list(_timers_of(node)):
        timer.cancel()


def raise_failure() -> None:
    """Raise what a call of this module has raised, where that can be handled.

    rclpy ends the process with a segmentation fault where a task raises (docs/upstream.md), so
    whoever spins an executor asks here after each turn.
    """
    if _failures:
        raise _failures.popleft()


def _timers_of(node: Node) -> set[Timer]:
    """Return the timers that a node owns: held by it alone, they go when it goes."""
    timers: set[Timer] = vars(node).setdefault('_hexapod_timers', set())
    return timers


class _Alarm:
    """One thread for the process, which sleeps until the next timer is due."""

    def __init__(self) -> None:
        self._waiting: list[tuple[int, int, ReferenceType[Timer]]] = []
        self._numbers = itertools.count()
        self._changed = threading.Condition()
        self._thread: threading.Thread | None = None

    def add(self, due_ns: int, timer: Timer) -> None:
        """Ring a timer at a moment of `time.monotonic_ns`."""
        with self._changed:
            entry = (due_ns, next(self._numbers), ref(timer))
            heapq.heappush(self._waiting, entry)
            if self._thread is None:
                self._thread = threading.Thread(target=self._run, name='timers', daemon=True)
                self._thread.start()
            elif self._waiting[0] is entry:
                self._changed.notify()

    def _run(self) -> None:
        while True:
            timer = self._next()()
            if timer is not None:
                timer.ring()
            del timer  # or this thread would keep it, and its node, until the next one is due

    def _next(self) -> ReferenceType[Timer]:
        """Wait until a timer is due and return it."""
        with self._changed:
            while True:
                wait_s = _LONGEST_WAIT_S
                if self._waiting:
                    wait_s = (self._waiting[0][0] - time.monotonic_ns()) / _SECOND_NS
                    if wait_s <= 0.0:
                        return heapq.heappop(self._waiting)[2]
                self._changed.wait(min(wait_s, _LONGEST_WAIT_S))


_alarm = _Alarm()
