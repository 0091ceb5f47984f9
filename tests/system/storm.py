# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Kills processes of a campaign at seeded random moments, and starts what was killed again."""

from __future__ import annotations

import os
import signal
import subprocess
import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import numpy as np

_LONGEST_WAIT_S = 60.0
_LONGEST_EARLY_S = 6.0


class Storm:
    """A manager that is started as often as it is killed, and the processes that it starts."""

    def __init__(self, start: Callable[[], subprocess.Popen[str]], runs: Path, seed: int) -> None:
        """Begin before the first process.

        Args:
            start: starts the manager.
            runs: folder that the bags are written to, by which progress is seen.
            seed: of the moments and the victims.
        """
        self.killed: Counter[str] = Counter()
        self._start = start
        self._runs = runs
        self._random = np.random.default_rng(seed)
        self.manager = start()

    def strike(self) -> None:
        """Wait for a moment and kill a process; start the manager again if it was the one."""
        if self._random.random() < 0.4:  # while processes start, as like as not
            self._wait(1, self._random.uniform(0.0, _LONGEST_EARLY_S))
        else:
            self._wait(int(self._random.integers(1, 8)), _LONGEST_WAIT_S)
            time.sleep(self._random.uniform(0.0, 0.02))
        assert self.manager.poll() is None, 'the campaign ended before the storm did'
        victims = [self.manager.pid, *children(self.manager.pid)]
        victim = int(self._random.choice(victims))
        self.killed['manager' if victim == self.manager.pid else 'worker'] += 1
        os.kill(victim, signal.SIGKILL)
        if victim == self.manager.pid:
            self.manager.wait()
            self.manager = self._start()

    def _wait(self, events: int, longest_s: float) -> None:
        """Wait until bags have grown so many times, but no longer than that."""
        deadline = time.monotonic() + longest_s
        before = self._size()
        while events and time.monotonic() < deadline and self.manager.poll() is None:
            time.sleep(0.005)
            now = self._size()
            events -= now != before
            before = now

    def _size(self) -> int:
        total = 0
        for folder, _, names in os.walk(self._runs):  # passes over what vanishes meanwhile
            for name in names:
                try:
                    total += Path(folder, name).stat().st_size if name.endswith('.mcap') else 0
                except FileNotFoundError:  # renamed meanwhile
                    continue
        return total


def children(pid: int) -> list[int]:
    """Return the processes that a process has started, oldest first."""
    found: set[int] = set()
    for task in Path(f'/proc/{pid}/task').glob('*/children'):
        try:
            found.update(map(int, task.read_text().split()))
        except (FileNotFoundError, ProcessLookupError):  # a thread that has ended meanwhile
            continue
    return sorted(found)
