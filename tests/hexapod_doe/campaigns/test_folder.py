# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import os
from pathlib import Path

import pytest
from hexapod_doe.bags.rosbag2 import partial_path
from hexapod_doe.campaigns.failures import FailureLog
from hexapod_doe.campaigns.folder import read_progress
from hexapod_doe.campaigns.progress import State
from mcap.reader import make_reader


def chunks_end(file: Path) -> int:
    """Return where the last chunk of an MCAP file ends."""
    with file.open('rb') as stream:
        summary = make_reader(stream).get_summary()
    last = summary.chunk_indexes[-1]
    return last.chunk_start_offset + last.chunk_length


def test_every_state_is_told_by_the_bags_alone(mixed):
    progress = read_progress(mixed.directory)
    assert list(progress.runs) == ['r4', 'r3', 'r2', 'r1']
    states = [run.state for run in progress.runs.values()]
    assert states == [State.DONE, State.RUNNING, State.INTERRUPTED, State.DUE]
    assert [len(run.returns) for run in progress.runs.values()] == [5, 2, 1, 0]
    assert progress.planned == 20


def test_a_run_says_what_its_bag_says(mixed):
    run = read_progress(mixed.directory).runs['r4']
    # The results of these tests earn 10 per episode number, and 5 on average.
    assert run.returns == [0.0, 10.0, 20.0, 30.0, 40.0]
    assert run.reward == 20.0
    assert (run.worker, run.planned, run.label) == ('/w1', 5, 'AB')


def test_the_rate_is_from_the_beginning_to_the_last_episode(mixed):
    file = partial_path(mixed.directory / 'runs' / 'r3') / 'r3_0.mcap'
    began = file.stat().st_mtime
    os.utime(file, (began + 8.0, began + 8.0))
    run = read_progress(mixed.directory).runs['r3']
    # Bags tell their beginning in whole seconds.
    assert run.seconds == pytest.approx(8.0, abs=1.01)
    assert run.episodes_per_second == pytest.approx(2 / run.seconds)


def test_carried_over_episodes_do_not_count_for_the_rate(folder):
    folder.begin('r4', 3, resumed='2')
    assert read_progress(folder.directory).runs['r4'].earlier == 2


def test_a_file_that_is_cut_counts_to_its_last_whole_chunk(folder):
    folder.cut('r3', 2)
    two = partial_path(folder.directory / 'runs' / 'r3') / 'r3_0.mcap'
    folder.cut('r4', 4)
    file = partial_path(folder.directory / 'runs' / 'r4') / 'r4_0.mcap'
    os.truncate(file, chunks_end(two) + 20)
    run = read_progress(folder.directory).runs['r4']
    assert run.state is State.INTERRUPTED
    assert run.returns == [0.0, 10.0]


@pytest.mark.parametrize('bytes_left', [0, 5])
def test_a_run_without_a_whole_chunk_has_no_episode(folder, bytes_left):
    folder.cut('r4', 1)
    file = partial_path(folder.directory / 'runs' / 'r4') / 'r4_0.mcap'
    os.truncate(file, bytes_left)
    assert read_progress(folder.directory).runs['r4'].returns == []


def test_done_runs_are_read_once(mixed, monkeypatch):
    before = read_progress(mixed.directory)
    after = read_progress(mixed.directory, before.runs)
    assert after.runs['r4'] is before.runs['r4']
    assert after.runs['r3'] is not before.runs['r3']


def test_a_row_failed_if_it_was_tried_in_vain_and_nobody_is_at_it(mixed):
    failures = FailureLog(mixed.directory)
    for run_id in ('r4', 'r3', 'r2', 'r1'):
        failures.add(run_id, '/w1', 'first reason')
        failures.add(run_id, '/w2', f'{run_id} again')
    runs = read_progress(mixed.directory).runs
    states = [run.state for run in runs.values()]
    assert states == [State.DONE, State.RUNNING, State.FAILED, State.FAILED]
    assert [run.reason for run in runs.values()] == ['', '', 'r2 again', 'r1 again']
