# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Threads that share the jobs of one control period."""

from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from types import TracebackType
from typing import Self

import torch

Job = Callable[[], None]


class Pool:
    """A fixed count of threads, the caller's own among them.

    MuJoCo and torch leave the interpreter to other threads while they compute. Which thread does
    a job makes no difference to its result.
    """

    def __init__(self, threads: int) -> None:
        """Start the threads.

        Raises:
            ValueError: There is no thread in it.
        """
        if threads < 1:
            raise ValueError(f'threads: {threads}, expected at least 1')
        self.threads = threads
        # A sum split over threads is not the same to the last bit: each computes with one.
        self._executor = ThreadPoolExecutor(
            max(threads - 1, 1), 'fleet', initializer=torch.set_num_threads, initargs=(1,)
        )

    def run(self, jobs: Iterable[Job]) -> None:
        """Do all jobs, each thread taking the next one when it is free.

        Raises:
            Exception: What a job raised; the others are done all the same.
        """
        queue = list(jobs)
        # Taking from a list's iterator is one step of the interpreter: no job goes out twice.
        remaining = iter(queue)

        def work() -> None:
            for job in remaining:
                job()

        helpers = min(self.threads, len(queue)) - 1
        futures = [self._executor.submit(work) for _ in range(helpers)]
        try:
            work()
        finally:
            for future in futures:
                future.result()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._executor.shutdown()
