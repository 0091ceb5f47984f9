# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Tells a process that works from one that only spins."""

import time
from collections.abc import Callable

WINDOW_S = 10.0
_SPINS_PER_S = 500
# A healthy turn of the executor serves about one callback; a storm serves one in thousands.
_SPINS_PER_CALLBACK = 100

_served = 0


def served() -> None:
    """Count a callback of ours that an executor has served."""
    global _served
    _served += 1


class NoProgressError(RuntimeError):
    """An executor wakes up over and over and serves nothing."""


class Watchdog:
    """Counts the turns of an executor's loop against the callbacks that they served."""

    def __init__(
        self, window_s: float = WINDOW_S, clock: Callable[[], float] = time.monotonic
    ) -> None:
        """Begin a window.

        Args:
            window_s: how long to count before judging.
            clock: tells the time, s.
        """
        self._window_s = window_s
        self._clock = clock
        self._begin(clock())

    def turned(self) -> None:
        """Count a turn of the loop.

        Raises:
            NoProgressError: a whole window of turns served next to nothing.
        """
        self._spins += 1
        now_s = self._clock()
        seconds = now_s - self._since_s
        if seconds < self._window_s:
            return
        spins, callbacks = self._spins, _served - self._served
        self._begin(now_s)
        if spins > _SPINS_PER_S * seconds and callbacks * _SPINS_PER_CALLBACK < spins:
            raise NoProgressError(
                f'the executor woke up {spins} times within {seconds:.0f} s and served '
                f'{callbacks} callbacks: expected about one callback per wake-up. The process '
                'ends, so that whoever started it can start it anew'
            )

    def _begin(self, now_s: float) -> None:
        self._since_s, self._spins, self._served = now_s, 0, _served
