# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""One campaign on two hosts: network namespaces joined by a cable that can be cut.

Each host has its own network and its own shared memory; a folder that both mount is all that they
share beside the cable.
"""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest
from hexapod_doe.bags.rosbag2 import partial_path
from hexapod_doe.bags.run_record import read_run
from hexapod_doe.campaigns.folder import read_progress
from hexapod_doe.campaigns.progress import State
from hexapod_doe.designs.plan_file import read_plan

pytestmark = pytest.mark.system

# Shared memory of its own for a host's processes: what the cable does not carry must not arrive.
ENTER = 'mount -t tmpfs shm /dev/shm && exec "$@"\n'
EPISODES = 10
WORKER = 'ros2 run hexapod_bringup worker_node --ros-args -p root:=. -r __ns:=/remote'
MANAGER = (
    'ros2 run hexapod_doe manager_node --ros-args -p plan:=plan.csv '
    f'-p episodes:={EPISODES} -p record_every:=0 -p config:={{config}} -p local_workers:=1 '
    '-p stall_timeout:=8.0'
)


class Hosts:
    """Two hosts on a cable."""

    def __init__(self, directory: Path) -> None:
        self.here, self.there = (f'hexapod{os.getpid()}{side}' for side in 'ab')
        self._enter = directory / 'enter.sh'
        self._enter.write_text(ENTER)

    def connect(self) -> None:
        """Make them, or raise what the system says against it."""
        for name in (self.here, self.there):
            ip(f'netns add {name}')
        ip(f'link add cable netns {self.here} type veth peer name cable netns {self.there}')
        for k, name in enumerate((self.here, self.there), start=1):
            ip(f'-n {name} address add 10.99.0.{k}/24 dev cable')
            ip(f'-n {name} link set lo up')
            ip(f'-n {name} link set cable up')

    def cut(self) -> None:
        """Break the cable."""
        ip(f'-n {self.here} link set cable down')

    def remove(self) -> None:
        """Forget whatever was made."""
        for name in (self.here, self.there):
            subprocess.run(['ip', 'netns', 'delete', name], capture_output=True, check=False)

    def on(self, host: str, line: str) -> str:
        """Return the line that runs a line on a host."""
        return f'ip netns exec {host} unshare --mount --ipc sh {self._enter} {line}'


def ip(arguments: str) -> None:
    subprocess.run(['ip', *arguments.split()], check=True, capture_output=True, text=True)


@pytest.fixture
def hosts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Hosts]:
    """Yield two connected hosts whose nodes look for each other beyond their own host."""
    if os.geteuid() != 0 or shutil.which('ip') is None or shutil.which('unshare') is None:
        pytest.skip('network namespaces need root, ip and unshare')
    made = Hosts(tmp_path)
    try:
        made.connect()
    except subprocess.CalledProcessError as error:
        made.remove()
        pytest.skip(f'no network namespaces here: {error.stderr.strip()}')
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'SUBNET')
    yield made
    made.remove()


@pytest.fixture
def plan(shell) -> Path:
    """Write a plan of four short runs."""
    line = 'ros2 run hexapod_doe plan --generators C=AB --factors 3 --seed 3 --out plan.csv'
    assert shell.call(line).returncode == 0
    (shell.directory / 'short.yaml').write_text(
        'task: {time_limit_steps: 60}\nddpg: {batch_size: 16, update_every: 6}\n'
        'training: {evaluation: 2}\n'
    )
    return shell.directory / 'plan.csv'


def test_a_cut_cable_loses_no_row(shell, plan: Path, hosts: Hosts) -> None:
    shell.start(hosts.on(hosts.there, WORKER))
    line = MANAGER.format(config=shell.directory / 'short.yaml')
    manager = shell.start(hosts.on(hosts.here, line))
    shell.until(lambda: begun_by('/remote', plan.parent), timeout_s=60.0)
    hosts.cut()
    assert manager.wait(120.0) == 0, shell.output()
    assert '4 of 4 runs' in shell.output()
    progress = read_progress(plan.parent)
    assert {run.state for run in progress.runs.values()} == {State.DONE}
    assert '/worker_1' in {run.worker for run in progress.runs.values()}
    for run_id in read_plan(plan).rows['run_id']:
        bag = plan.parent / 'runs' / run_id
        episodes = read_run(bag).episodes
        assert list(episodes.index) == list(range(EPISODES))
        assert not episodes[['late', 'missing', 'duplicate', 'out_of_order']].any().any()
        assert not partial_path(bag).exists()


def begun_by(worker: str, directory: Path) -> bool:
    """Whether a worker has a run with an episode in it."""
    runs = read_progress(directory).having(State.RUNNING)
    return any(run.worker == worker and run.returns for run in runs)
