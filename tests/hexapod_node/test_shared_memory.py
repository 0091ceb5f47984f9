# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What killed participants leave is freed, what live ones own is not."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from hexapod_node.shared_memory import free_abandoned

SHM = Path('/dev/shm')
OWNER = """
import fcntl, sys, time
file = open(sys.argv[1])
fcntl.flock(file, fcntl.LOCK_EX)
print('held', flush=True)
time.sleep(600)
"""
PARTICIPANT = """
import time, rclpy
rclpy.init()
node = rclpy.create_node('left_behind')
print('up', flush=True)
time.sleep(600)
"""
SEGMENT = 'fastrtps_0123456789abcdef'


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder as a participant leaves it, some time after its beginning."""
    for name, size in ((SEGMENT, 549_408), (f'{SEGMENT}_el', 0), ('fastrtps_port7413', 52_400)):
        (tmp_path / name).write_bytes(bytes(size))
        os.utime(tmp_path / name, (1e9, 1e9))
    return tmp_path


@pytest.fixture
def owner(folder: Path) -> Iterator[subprocess.Popen[str]]:
    """The process that holds the segment."""
    process = subprocess.Popen(
        [sys.executable, '-c', OWNER, str(folder / f'{SEGMENT}_el')],
        stdout=subprocess.PIPE,
        text=True,
    )
    assert process.stdout is not None
    assert process.stdout.readline() == 'held\n'
    yield process
    process.kill()
    process.wait()


def test_what_a_live_process_owns_stays(folder, owner, capsys) -> None:
    free_abandoned(folder)
    assert (folder / SEGMENT).exists()
    assert capsys.readouterr().err == ''


def test_what_a_killed_process_left_goes_and_is_told(folder, owner, capsys) -> None:
    owner.send_signal(signal.SIGKILL)
    owner.wait()
    free_abandoned(folder)
    assert [file.name for file in folder.iterdir()] == ['fastrtps_port7413']
    (line,) = capsys.readouterr().err.splitlines()
    assert 'freed 0.5 MB' in line
    free_abandoned(folder)
    assert capsys.readouterr().err == ''


def test_a_participant_that_is_about_to_lock_is_left_alone(folder) -> None:
    (folder / f'{SEGMENT}_el').touch()
    free_abandoned(folder)
    assert (folder / SEGMENT).exists()


def test_files_of_others_stay(folder) -> None:
    others = {'fastrtps_port7413_el', 'sem.fastrtps_port7413_mutex', 'fastrtps_xyz_el', 'psm_1'}
    for name in others:
        (folder / name).touch()
        os.utime(folder / name, (1e9, 1e9))
    free_abandoned(folder)
    assert others <= {file.name for file in folder.iterdir()}


def test_a_host_without_the_folder_is_no_error(tmp_path) -> None:
    free_abandoned(tmp_path / 'nowhere')


def test_a_real_participant_owns_its_segment_until_it_is_killed() -> None:
    process = subprocess.Popen(
        [sys.executable, '-c', PARTICIPANT], stdout=subprocess.PIPE, text=True
    )
    try:
        assert process.stdout is not None
        assert process.stdout.readline() == 'up\n'
        owned = [Path(os.readlink(link)) for link in Path(f'/proc/{process.pid}/fd').iterdir()]
        locks = [file for file in owned if file.parent == SHM and 'port' not in file.name]
        assert locks
        for lock in locks:
            os.utime(lock, (1e9, 1e9))
        free_abandoned()
        assert all(lock.exists() for lock in locks)
    finally:
        process.kill()
        process.wait()
    free_abandoned()
    assert not any(lock.exists() or Path(str(lock)[:-3]).exists() for lock in locks)
