# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""How late periodic ticks are: counts and quantiles over any time, in constant memory."""

import math

LATE_NS = 5_000_000
"""A tick later than this counts as late."""

_MS = 1e-6
# Quantiles are read off a histogram: they are right to the width of its bins.
_BIN_NS = 100_000
_BINS = 1000


class TickMeter:
    """Gathers the lateness of ticks.

    Attributes:
        ticks: Ticks served.
        missed: Ticks that were due but had to be left out.
        late: Ticks later than `LATE_NS`, the missed ones included.
    """

    def __init__(self) -> None:
        self.restart()

    def restart(self) -> None:
        """Forget everything so far."""
        self.ticks = self.missed = self.late = 0
        self._histogram = [0] * (_BINS + 1)
        self._sum = self._sum_of_squares = 0.0
        self._greatest_ns = 0

    def add(self, late_ns: int, missed: int = 0) -> None:
        """Count a tick that was served so late, and those that were missed since the last one."""
        self.ticks += 1
        self.missed += missed
        self.late += missed + (late_ns > LATE_NS)
        self._histogram[min(late_ns // _BIN_NS, _BINS)] += 1
        self._sum += late_ns
        self._sum_of_squares += late_ns * late_ns
        self._greatest_ns = max(self._greatest_ns, late_ns)

    @property
    def late_share(self) -> float:
        """Share of the ticks that came late or not at all."""
        due = self.ticks + self.missed
        return self.late / due if due else 0.0

    def quantile_ms(self, share: float) -> float:
        """Return the lateness [ms] that this share of the ticks does not exceed; NaN for none."""
        wanted = math.ceil(share * self.ticks)
        if not wanted:
            return math.nan
        seen = 0
        for index, count in enumerate(self._histogram[:_BINS]):
            seen += count
            if seen >= wanted:
                return min((index + 1) * _BIN_NS, self._greatest_ns) * _MS
        return self._greatest_ns * _MS

    @property
    def jitter_ms(self) -> float:
        """Standard deviation of the lateness [ms]; NaN for none."""
        if not self.ticks:
            return math.nan
        mean = self._sum / self.ticks
        return math.sqrt(max(self._sum_of_squares / self.ticks - mean * mean, 0.0)) * _MS

    def values(self) -> dict[str, object]:
        """Return what the diagnostics show."""
        return {
            'ticks': self.ticks,
            'missed_ticks': self.missed,
            'late_ticks': self.late,
            'late_share': f'{self.late_share:.4f}',
            'lateness_median_ms': f'{self.quantile_ms(0.5):.2f}',
            'lateness_p99_ms': f'{self.quantile_ms(0.99):.2f}',
            'lateness_max_ms': f'{self._greatest_ns * _MS:.2f}',
            'jitter_ms': f'{self.jitter_ms:.2f}',
        }
