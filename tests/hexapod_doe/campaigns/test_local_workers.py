# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Local workers are started again when they die, and live no longer than who started them."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from hexapod_doe.campaigns.local_workers import LIFELINE, LocalWorkers
from hexapod_node import lifeline

WORKER = """
import os, signal, sys, time
from hexapod_node.lifeline import follow
follow()
signal.signal(signal.SIGINT, signal.default_int_handler)  # as rclpy does, also in background jobs
open(sys.argv[1], 'w').write(str(os.getpid()))
try:
    time.sleep(600)
except KeyboardInterrupt:
    open(sys.argv[1] + '.ended', 'w').close()
"""
# Stands between, as `ros2 run` of a full ROS installation does.
RUNNER = """
import subprocess, sys
node = subprocess.Popen([sys.executable, *sys.argv[1:]])
while node.returncode is None:
    try:
        node.wait()
    except KeyboardInterrupt:
        pass
"""
DIRECT = f'{sys.executable} worker.py {{name}}'
NESTED = f'{sys.executable} runner.py worker.py {{name}}'
MANAGER = """
import sys, time
from pathlib import Path
from hexapod_doe.campaigns.local_workers import LocalWorkers
workers = LocalWorkers(2, sys.argv[1], Path('logs'))
print('started', flush=True)
time.sleep(600)
"""


def until(predicate, timeout_s: float = 20.0):
    deadline = time.monotonic() + timeout_s
    while not (value := predicate()):
        assert time.monotonic() < deadline
        time.sleep(0.02)
    return value


def identity(path: Path) -> int:
    """Return the process number that a worker has written, 0 while there is none."""
    text = path.read_text() if path.exists() else ''
    return int(text) if text else 0


def alive(pid: int) -> bool:
    try:
        return Path(f'/proc/{pid}/stat').read_text().rsplit(')', 1)[1].split()[0] != 'Z'
    except FileNotFoundError:
        return False


@pytest.fixture
def folder(tmp_path, monkeypatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / 'worker.py').write_text(WORKER)
    (tmp_path / 'runner.py').write_text(RUNNER)
    return tmp_path


@pytest.fixture
def workers(folder):
    made = LocalWorkers(2, DIRECT, folder / 'logs')
    yield made
    made.stop()


def test_dead_worker_is_started_again_under_a_name_of_its_own(folder, workers):
    first, other = (until(lambda n=n: identity(folder / f'worker_{n}')) for n in (1, 2))
    os.kill(first, signal.SIGKILL)
    ends = until(workers.revive)
    assert ends == {'worker_1': f'ended with status -9, see {folder}/logs/worker_1.log'}
    until(lambda: workers.revive() or identity(folder / 'worker_1_2'))
    assert alive(identity(folder / 'worker_1_2'))
    assert alive(other)
    assert workers.revive() == {}


def test_kill_ends_a_worker_that_does_not_move(folder, workers):
    first = until(lambda: identity(folder / 'worker_1'))
    os.kill(first, signal.SIGSTOP)
    assert workers.kill('worker_1')
    until(lambda: not alive(first))
    assert not workers.kill('elsewhere')


def test_worker_that_ends_at_once_is_started_ever_later(folder):
    workers = LocalWorkers(1, 'true', folder / 'logs')
    ends: list[str] = []
    deadline = time.monotonic() + 4.0
    while time.monotonic() < deadline:
        ends += workers.revive()
        time.sleep(0.01)
    workers.stop()
    # Pauses of 1 s and 3 s: three lives at most, where there could have been a hundred.
    assert 1 <= len(ends) <= 3
    assert ends[0] == 'worker_1'


@pytest.mark.parametrize('command', [DIRECT, NESTED], ids=['direct', 'behind another process'])
@pytest.mark.parametrize('number', [signal.SIGKILL, signal.SIGSEGV])
def test_workers_end_with_a_manager_that_is_killed(folder, command, number):
    manager = subprocess.Popen(
        [sys.executable, '-c', MANAGER, command],
        stdout=subprocess.PIPE,
        text=True,
    )
    pids = [until(lambda n=n: identity(folder / f'worker_{n}')) for n in (1, 2)]
    manager.send_signal(number)
    manager.wait()
    until(lambda: not any(alive(pid) for pid in pids))


@pytest.mark.parametrize('command', [DIRECT, NESTED], ids=['direct', 'behind another process'])
def test_stopping_lets_all_of_them_end_in_order(folder, command):
    workers = LocalWorkers(2, command, folder / 'logs')
    pids = [until(lambda n=n: identity(folder / f'worker_{n}')) for n in (1, 2)]
    workers.stop()
    assert not any(alive(pid) for pid in pids)
    assert all((folder / f'worker_{n}.ended').exists() for n in (1, 2))


def test_stopping_does_not_wait_for_one_that_hangs(folder, workers, monkeypatch):
    pids = [until(lambda n=n: identity(folder / f'worker_{n}')) for n in (1, 2)]
    for pid in pids:
        os.kill(pid, signal.SIGSTOP)
    monkeypatch.setattr('hexapod_doe.campaigns.children._STOP_S', 0.5)
    workers.stop()
    assert not any(alive(pid) for pid in pids)


def test_both_ends_of_the_lifeline_have_one_name():
    assert LIFELINE == lifeline.LIFELINE
