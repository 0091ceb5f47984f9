# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Cut recordings are kept as long as a run may go on from them, and no longer."""

import shutil
from pathlib import Path

import pytest
from hexapod_doe.bags.carry_over import open_recording
from hexapod_doe.bags.cuts import cuts_of, forget_cuts_of_closed
from hexapod_doe.bags.recording import Recording
from hexapod_doe.bags.salvage import set_aside

TOPIC = '/w0/episode_result'


@pytest.fixture
def attempt(tmp_path, samples):
    """Return what begins the run, with so many episodes carried over, and records more."""

    def attempt(keep: int, until: int, **metadata: str) -> Recording:
        set_aside(tmp_path / 'r1')
        said = {'observations': 'A', 'seed': '1', 'episodes': '9'} | metadata
        recording, kept, _ = open_recording('r1', tmp_path / 'r1', said, 0, keep, TOPIC)
        for episode in range(kept, until):
            data = samples.serialised_result(episode)
            recording.add_result(samples.results, data, episode, 600)
        return recording

    return attempt


def names(folder: Path) -> list[str]:
    return [cut.name for cut in cuts_of(folder / 'r1')]


def test_preemption_leaves_one_cut_and_a_finished_run_none(attempt, tmp_path):
    for keep in (0, 2, 4, 6):
        attempt(keep, keep + 3).abandon()
        assert len(names(tmp_path)) <= 1
    attempt(9, 9).finish(9, {})
    assert names(tmp_path) == []


def test_attempts_before_the_first_checkpoint_leave_nothing(attempt, tmp_path):
    for _ in range(4):
        attempt(0, 1).abandon()
    assert names(tmp_path) == []


def test_recordings_of_another_run_and_other_folders_stay(attempt, tmp_path):
    attempt(0, 1, seed='2').abandon()
    (tmp_path / 'r1.cut_old').mkdir()
    attempt(0, 9).finish(9, {})
    assert names(tmp_path) == ['r1.cut_1']
    assert (tmp_path / 'r1.cut_old').is_dir()


def test_a_damaged_bag_is_kept_until_the_run_has_another(attempt, tmp_path):
    attempt(0, 9).finish(9, {})
    with (tmp_path / 'r1' / 'r1_0.mcap').open('r+b') as file:
        file.seek(100)
        file.write(b'rot')
    attempt(0, 1).abandon()
    attempt(0, 1).abandon()
    assert 'r1.cut_1' in names(tmp_path)
    attempt(0, 9).finish(9, {})
    assert names(tmp_path) == []


def test_a_link_that_stands_for_a_cut_goes_and_what_it_leads_to_stays(attempt, tmp_path):
    (tmp_path / 'r1').symlink_to(tmp_path / 'gone')
    attempt(0, 9).finish(9, {})
    assert not (tmp_path / 'r1').is_symlink()
    assert names(tmp_path) == []


def test_what_a_kill_at_the_end_left_of_a_finished_run_goes_at_the_next_start(attempt, tmp_path):
    attempt(0, 3).abandon()
    shutil.copytree(tmp_path / 'r1.partial', tmp_path / 'kept')
    attempt(3, 9).finish(9, {})
    (tmp_path / 'kept').rename(tmp_path / 'r1.cut_1')
    forget_cuts_of_closed(tmp_path / 'r1')
    assert names(tmp_path) == []
    assert (tmp_path / 'r1').is_dir()
