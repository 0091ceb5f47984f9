# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""How the time of a fleet divides among the parts of its work."""

import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

PARTS = ('physics', 'cpg', 'learner')


class Stopwatch:
    """Processor time by part, summed over threads: other load on the machine does not count.

    A wait for a device counts as far as the processor is kept busy with it.
    """

    def __init__(self) -> None:
        self._seconds = dict.fromkeys(PARTS, 0.0)
        self._lock = threading.Lock()
        self._began = time.process_time()

    @contextmanager
    def part(self, name: str) -> Iterator[None]:
        """Count what all threads do during the block towards one of `PARTS`."""
        began = time.process_time()
        yield
        self._add(name, time.process_time() - began)

    def timed(self, name: str, job: Callable[[], None]) -> Callable[[], None]:
        """Return the job, which counts what its own thread does towards a part."""

        def run() -> None:
            began = time.thread_time()
            job()
            self._add(name, time.thread_time() - began)

        return run

    def _add(self, name: str, seconds: float) -> None:
        with self._lock:
            self._seconds[name] += seconds

    def shares(self) -> dict[str, float]:
        """Return the share of each part in the process's time since the start, and the rest."""
        total = time.process_time() - self._began
        shares = {name: seconds / total for name, seconds in self._seconds.items()}
        return shares | {'rest': 1.0 - sum(shares.values())}
