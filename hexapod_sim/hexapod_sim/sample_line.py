# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""When a device's samples come: its own rate, lost samples, and the delay on their way."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from typing import Generic, TypeVar

import numpy as np

Item = TypeVar('Item')


@dataclass(frozen=True)
class Timing:
    """How samples of the truth become samples of a device."""

    delay: float = 0.0
    """From measurement to delivery [s]; in effect up to the next sample of the source."""
    dropout: float = 0.0
    """Chance of a sample to be lost."""
    rate: float = 0.0
    """Samples per second; 0 for those of the source [Hz]."""
    hold: bool = False
    """Deliver one sample per sample of the source, the newest that has arrived, as if measured
    now: what the lock-step needs, where every period has its sample."""

    def __post_init__(self) -> None:
        """Refuse what no device does."""
        if not (self.delay >= 0.0 and self.rate >= 0.0 and 0.0 <= self.dropout < 1.0):
            raise ValueError(
                f'delay {self.delay}, rate {self.rate}, dropout {self.dropout}: expected '
                'none negative and a dropout below 1'
            )


class SampleLine(Generic[Item]):
    """Takes the samples of the source in, and gives those of the device out."""

    def __init__(self, timing: Timing, seed: int) -> None:
        """Begin empty; the seed decides which samples are lost."""
        self._timing = timing
        self._seed = seed
        self._due_ns: float | None = None
        self._under_way: deque[tuple[int, Item]] = deque()
        self._held: Item | None = None
        self.lost = 0

    @property
    def holds(self) -> bool:
        """Whether every sample of the source gives one."""
        return self._timing.hold

    def offer(self, stamp_ns: int, item: Item) -> list[tuple[int, Item]]:
        """Take a sample, and return (stamp, sample) of what is delivered by then."""
        if self._measured(stamp_ns):
            if self._dropped(stamp_ns):
                self.lost += 1
            else:
                # Time went back, or a stamp was wrong: nobody waits for what lies ahead of it.
                while self._under_way and self._under_way[-1][0] > stamp_ns:
                    self._under_way.pop()
                self._under_way.append((stamp_ns, item))
        delivered = []
        arrived_ns = stamp_ns - round(self._timing.delay * 1e9)
        while self._under_way and self._under_way[0][0] <= arrived_ns:
            delivered.append(self._under_way.popleft())
        if not self._timing.hold:
            return delivered
        if delivered:
            self._held = delivered[-1][1]
        elif self._held is None:  # nothing has arrived yet: a device begins with a good sample
            self._held = item
        return [(stamp_ns, self._held)]

    def _measured(self, stamp_ns: int) -> bool:
        """Whether the device measures now; a source that begins anew begins its time anew."""
        if not self._timing.rate:
            return True
        period_ns = 1e9 / self._timing.rate
        if self._due_ns is None or abs(stamp_ns - self._due_ns) > 10.0 * period_ns:
            self._due_ns = float(stamp_ns)
        if stamp_ns < self._due_ns:
            return False
        self._due_ns += period_ns
        return True

    def _dropped(self, stamp_ns: int) -> bool:
        """Whether the sample is lost; the same seed and stamp give the same answer."""
        if not self._timing.dropout:
            return False
        key = np.array([self._seed, np.iinfo(np.uint64).max], dtype=np.uint64)
        counter = np.array([0, 0, stamp_ns, 0], dtype=np.uint64)
        generator = np.random.Generator(np.random.Philox(key=key, counter=counter))
        return bool(generator.random() < self._timing.dropout)
