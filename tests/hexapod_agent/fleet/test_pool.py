# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A pool does every job once, over its threads, and tells of the one that failed."""

import threading
from functools import partial

import pytest
import torch
from hexapod_agent.fleet.pool import Pool


@pytest.mark.parametrize('threads', [1, 3])
def test_each_job_is_done_once(threads):
    done: list[int] = []
    with Pool(threads) as pool:
        pool.run(partial(done.append, number) for number in range(200))
        pool.run([])
    assert sorted(done) == list(range(200))


def test_jobs_run_at_once_and_compute_with_one_thread():
    meeting = threading.Barrier(3, timeout=20.0)  # passes only if three wait at it together
    counts: list[int] = []

    def job() -> None:
        meeting.wait()
        counts.append(torch.get_num_threads())

    torch.set_num_threads(1)  # as every trainer does, in the thread that it is made in
    with Pool(3) as pool:
        pool.run([job] * 3)
    assert counts == [1, 1, 1]


def test_error_of_a_job_is_raised_after_the_others_are_done():
    done: list[int] = []

    def fail() -> None:
        raise RuntimeError('job 7 failed')

    with Pool(2) as pool:
        jobs = [partial(done.append, number) for number in range(20)]
        with pytest.raises(RuntimeError, match='job 7 failed'):
            pool.run([*jobs[:7], fail, *jobs[7:]])
    assert sorted(done) == list(range(20))


def test_a_pool_without_threads_is_refused():
    with pytest.raises(ValueError, match='threads: 0, expected at least 1'):
        Pool(0)
