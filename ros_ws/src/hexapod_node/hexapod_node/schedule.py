# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Which tick of a fixed period is due, how late it is, and how many were missed before it."""

from __future__ import annotations

from dataclasses import dataclass


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
