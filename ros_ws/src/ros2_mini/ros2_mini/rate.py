# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The rate of a stream of messages over a window, as `ros2 topic hz` shows it."""

from collections import deque
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Statistics:
    """Periods between messages over a window [s]."""

    rate: float
    """Mean rate [Hz]; 0 if the clock stood still."""
    shortest: float
    longest: float
    deviation: float
    """Standard deviation of the periods, with the number of periods as divisor [s]."""
    window: int
    """Number of periods."""

    def __str__(self) -> str:
        return (
            f'average rate: {self.rate:.3f}\n\tmin: {self.shortest:.3f}s max: {self.longest:.3f}s '
            f'std dev: {self.deviation:.5f}s window: {self.window}'
        )


class RateMeter:
    """Collects the times at which messages came."""

    def __init__(self, window: int) -> None:
        self._periods: deque[int] = deque(maxlen=window)
        self._last: int | None = None
        self._news = False

    def add(self, now: int) -> None:
        """Note a message at `now` [ns]; start over if the time has gone back.

        A time of 0 means that the simulation has not given the time yet.
        """
        if now == 0 or (self._last is not None and now < self._last):
            self._periods.clear()
            self._last = now or None
            return
        if self._last is not None:
            self._periods.append(now - self._last)
            self._news = True
        self._last = now

    def take(self) -> Statistics | None:
        """Return the statistics, or None if no message has come since the last call."""
        if not self._news or not self._periods:
            return None
        self._news = False
        periods = np.array(self._periods) * 1e-9
        mean = float(periods.mean())
        return Statistics(
            rate=1.0 / mean if mean > 0.0 else 0.0,
            shortest=float(periods.min()),
            longest=float(periods.max()),
            deviation=float(periods.std()),
            window=len(periods),
        )


def table(rows: dict[str, Statistics]) -> str:
    """Return the statistics of several topics, a line each."""
    header = ('topic', 'rate', 'min_delta', 'max_delta', 'std_dev', 'window')
    cells = [
        (
            topic,
            f'{row.rate:.3f}',
            f'{row.shortest:.3f}',
            f'{row.longest:.3f}',
            f'{row.deviation:.5f}',
            str(row.window),
        )
        for topic, row in rows.items()
    ]
    widths = [max(map(len, column)) for column in zip(header, *cells, strict=True)]
    title = '   '.join(word.center(width) for word, width in zip(header, widths, strict=True))
    lines = [
        '   '.join(cell.ljust(width) for cell, width in zip(row, widths, strict=True))
        for row in cells
    ]
    return '\n'.join([title, '=' * len(title), *lines]) + '\n'
