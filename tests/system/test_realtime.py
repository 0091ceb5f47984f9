# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The robot in real time as users start it: by launch file, and by the report's one command."""

from __future__ import annotations

import re
import signal

import pytest
from hexapod_agent.learning import checkpoint
from hexapod_agent.learning.training import Trainer
from hexapod_agent.specification.run_spec import RunSpec

pytestmark = pytest.mark.system
SMALL = {'actor': {'hidden': [16, 12]}, 'critic': {'hidden': [16, 12]}}


@pytest.fixture
def agent(shell) -> str:
    trainer = Trainer(RunSpec.from_mapping(SMALL, 'small').observing('CE'), 5)
    checkpoint.save_agent(shell.directory / 'agent.pt', trainer)
    return 'agent.pt'


def test_a_robot_is_launched_managed_and_interrupted(shell, agent: str) -> None:
    launch = shell.start(
        f'ros2 launch hexapod_bringup simulated_robot.launch.xml checkpoint:={agent} namespace:=/r'
    )
    shell.until(lambda: 'drives, observing CE' in shell.output(), 90.0)
    assert shell.run('ros2 lifecycle get /r/cpg').stdout.strip() == 'active [3]'
    assert 'successful' in shell.run('ros2 lifecycle set /r/cpg deactivate').stdout
    assert shell.run('ros2 lifecycle get /r/cpg').stdout.strip() == 'inactive [2]'
    launch.send_signal(signal.SIGINT)
    assert launch.wait(15.0) == 0, shell.output()
    assert 'Traceback' not in shell.output()


@pytest.mark.alone
def test_one_command_reports_how_late_the_ticks_are(shell, agent: str) -> None:
    ended = shell.run(f'ros2 run hexapod_bringup realtime_report --seconds 3 --checkpoint {agent}')
    # How late depends on what else the machine does.
    assert ended.returncode in (0, 1), ended.stderr
    for name in ('sim', 'cpg', 'play'):
        row = re.search(rf'{name}\W+(\d+)\W', ended.stdout)
        assert row is not None
        assert int(row.group(1)) > 80
    held = '40 Hz held' in ended.stdout
    assert held == (ended.returncode == 0)


def test_an_agent_that_cannot_drive_is_told_with_the_reason(shell) -> None:
    ended = shell.run('ros2 run hexapod_bringup realtime_report --checkpoint no.pt')
    assert ended.returncode == 2
    assert 'no.pt' in ended.stderr
    assert 'not found' in ended.stderr
