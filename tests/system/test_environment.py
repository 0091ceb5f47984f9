# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Commands where HOME, the file system or a variable is not what a workstation has."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from hexapod_doe.bags.run_record import is_complete

pytestmark = pytest.mark.system
NO_FLOCK = Path(__file__).with_name('noflock.c')
CASE = (
    'ros2 run hexapod_doe run_case --plan plan.csv --row 1 --episodes 1 --record-every 0 '
    '--config short.yaml'
)
PLAN = """\
StdOrder,RunOrder,case,replicate,seed,run_id,observations,A,B
1,1,1,1,11,r1,,-1,-1
"""


@pytest.fixture
def campaign(shell) -> Path:
    """The folder of a plan with one short run, which is the shell's."""
    (shell.directory / 'plan.csv').write_text(PLAN)
    (shell.directory / 'short.yaml').write_text(
        'task: {time_limit_steps: 20}\nddpg: {batch_size: 16, update_every: 8}\n'
        'training: {evaluation: 0}\n'
    )
    return shell.directory


def one_line(ended: subprocess.CompletedProcess[str]) -> str:
    assert ended.returncode not in (0, None)
    (line,) = ended.stderr.splitlines()
    return line


def test_a_job_without_a_home_runs(shell, campaign, monkeypatch) -> None:
    monkeypatch.setenv('HOME', '/dev/null')
    monkeypatch.delenv('ROS_LOG_DIR')
    monkeypatch.setenv('TMPDIR', str(campaign))
    ended = shell.run(CASE)
    assert ended.returncode == 0, ended.stderr
    assert is_complete(campaign / 'runs' / 'r1')
    assert [line for line in ended.stderr.splitlines() if 'ROS_LOG_DIR' in line] != []
    assert 'Traceback' not in ended.stderr


def test_a_job_where_files_cannot_be_locked_names_the_folder(shell, campaign, monkeypatch) -> None:
    library = campaign / 'noflock.so'
    subprocess.run(['gcc', '-shared', '-fPIC', '-o', library, NO_FLOCK], check=True)
    monkeypatch.setenv('LD_PRELOAD', str(library))
    line = one_line(shell.run(CASE))
    assert str(campaign) in line
    assert 'flock' in line


@pytest.mark.parametrize(
    'command',
    [
        'ros2 topic list',
        'ros2 run hexapod_cpg cpg_node',
        'ros2 launch hexapod_bringup description.launch.xml',
        'python -m hexapod_sim.nodes.sim_node',
    ],
)
@pytest.mark.parametrize(
    ('variable', 'value'),
    [('ROS_DOMAIN_ID', 'abc'), ('RMW_IMPLEMENTATION', 'rmw_cyclonedds_cpp')],
)
def test_a_wrong_variable_is_one_line(shell, monkeypatch, command, variable, value) -> None:
    monkeypatch.setenv(variable, value)
    line = one_line(shell.run(command))
    assert f"{variable}='{value}'" in line
