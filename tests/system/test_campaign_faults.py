# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""One fault at a time: a second manager, workers that hang, disks that refuse."""

from __future__ import annotations

import os
import signal
import subprocess
from pathlib import Path

import pytest
from hexapod_doe.bags.salvage import whole_records
from mcap.records import Channel

from .short_campaign import TWO_RUNS, ShortCampaign
from .storm import children

pytestmark = pytest.mark.system
WORKER = 'ros2 run hexapod_bringup worker_node --ros-args -p root:=. -r __ns:=/far'


@pytest.fixture
def campaign(shell) -> ShortCampaign:
    return ShortCampaign(shell, shell.directory / 'campaign', TWO_RUNS, 60)


def results_of(campaign: ShortCampaign, worker: str) -> bool:
    """Whether a bag, finished or not, holds something that a worker has published."""
    topic = f'/{worker}/episode_result'
    return any(topic in topics_of(file) for file in campaign.runs.glob('*/*.mcap'))


def topics_of(file: Path) -> set[str]:
    """Return the topics in the whole chunks of a file that may still be written."""
    try:
        with file.open('rb') as stream:
            return {r.topic for r in whole_records(stream) if isinstance(r, Channel)}
    except FileNotFoundError:  # it has just been renamed
        return set()


def test_a_second_manager_is_one_clear_error(shell, campaign: ShortCampaign, told) -> None:
    first = campaign.start(workers=0)
    shell.until(lambda: (campaign.plan.parent / 'campaign.lock').exists())
    second = campaign.start(workers=1)
    assert second.wait(30.0) == 1
    (line,) = told((shell.directory / 'output_1').read_text())
    assert f'campaign {campaign.plan.parent}: process {first.pid} on ' in line
    assert first.poll() is None
    first.kill()
    first.wait()
    assert campaign.start(workers=1).wait(100.0) == 0, shell.output()


def test_a_local_worker_that_hangs_is_replaced(shell, campaign: ShortCampaign) -> None:
    manager = campaign.start(workers=1, stall_timeout=3.0)
    shell.until(lambda: results_of(campaign, 'worker_1'))
    (worker,) = children(manager.pid)
    os.kill(worker, signal.SIGSTOP)
    assert manager.wait(100.0) == 0, shell.output()
    assert 'is due again, /worker_1: no sign of life for 3 s' in shell.output()
    campaign.assert_as_alone()


def test_a_far_worker_that_hangs_gives_its_row_away_and_comes_back(
    shell, campaign: ShortCampaign
) -> None:
    far = shell.start(WORKER)
    manager = campaign.start(workers=0, stall_timeout=3.0)
    shell.until(lambda: results_of(campaign, 'far'))
    far.send_signal(signal.SIGSTOP)
    near = shell.start(WORKER.replace('far', 'near'))
    given_away = 'is due again, /far: no sign of life for 3 s'
    shell.until(lambda: given_away in shell.output(), timeout_s=60.0)
    far.send_signal(signal.SIGCONT)
    assert manager.wait(100.0) == 0, shell.output()
    assert far.poll() is None
    assert near.poll() is None
    campaign.assert_as_alone()


@pytest.mark.slow
@pytest.mark.parametrize('victim', ['sim', 'cpg', 'recorder', 'agent'])
def test_a_worker_that_loses_a_node_loses_its_row_to_another(
    shell, campaign: ShortCampaign, victim: str
) -> None:
    line = 'ros2 run hexapod_{package} {node}_node --ros-args -r __ns:=/far'
    packages = {'sim': 'sim', 'cpg': 'cpg', 'recorder': 'doe', 'agent': 'agent'}
    far = {n: shell.start(line.format(package=p, node=n)) for n, p in packages.items()}
    manager = campaign.start(workers=0, stall_timeout=15.0)
    shell.until(lambda: results_of(campaign, 'far'), timeout_s=60.0)
    far[victim].kill()
    shell.start(WORKER.replace('far', 'near'))
    assert manager.wait(200.0) == 0, shell.output()
    campaign.assert_as_alone()


@pytest.fixture
def small_disk(tmp_path: Path):
    """Mount a file system of two megabytes and return its folder."""
    folder = tmp_path / 'disk'
    folder.mkdir()
    if os.geteuid() != 0 or not mount('-t', 'tmpfs', '-o', 'size=2m', 'none', str(folder)):
        pytest.skip('this machine does not let tests mount a file system')
    yield folder
    subprocess.run(['umount', '-l', str(folder)], check=True)


def mount(*options: str) -> bool:
    return subprocess.run(['mount', *options], capture_output=True, check=False).returncode == 0


def test_a_full_disk_ends_the_campaign_and_loses_nothing(shell, small_disk: Path) -> None:
    campaign = ShortCampaign(shell, small_disk, TWO_RUNS, 20)
    (small_disk / 'thesis.pdf').write_bytes(bytes(1_900_000))
    assert campaign.start(workers=1).wait(100.0) == 1, shell.output()
    complaint = f'campaign {small_disk}: cannot write: No space left on device; what is done stays'
    assert complaint in shell.output()
    assert mount('-o', 'remount,size=16m', str(small_disk))
    assert campaign.start(workers=1).wait(100.0) == 0, shell.output()
    campaign.assert_as_alone()


def test_a_read_only_folder_is_one_clear_error(shell, small_disk: Path, told) -> None:
    campaign = ShortCampaign(shell, small_disk, TWO_RUNS, 20)
    assert mount('-o', 'remount,ro', str(small_disk))
    assert campaign.start(workers=1).wait(30.0) == 1
    (line,) = told(shell.output())
    assert f'campaign {small_disk}: cannot write: Read-only file system' in line
