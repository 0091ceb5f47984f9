# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import asyncio
import os
import signal
import time
from pathlib import Path

import pytest
from ros2_mini.launch import supervisor
from ros2_mini.launch.log import LaunchLog, make_log_directory
from ros2_mini.launch.supervisor import Plan, ProcessSpec, Supervisor


@pytest.fixture
def run(tmp_path, capsys):
    """Run processes given as shell scripts; return exit status, screen and log."""

    def run_scripts(*scripts: str, **settings) -> tuple[int, str, str]:
        specs = [
            ProcessSpec(f'sh-{i}', ('sh', '-c', script), dict(os.environ), **settings)
            for i, script in enumerate(scripts, 1)
        ]
        with LaunchLog(tmp_path) as log:
            status = asyncio.run(Supervisor(Plan(specs), log).run())
        return status, capsys.readouterr().out, (tmp_path / 'launch.log').read_text()

    return run_scripts


def test_every_line_bears_the_name_of_its_process(run):
    status, screen, _ = run('echo one; printf two', 'echo err >&2', output='screen')
    assert status == 0
    assert {'[sh-1] one', '[sh-1] two', '[sh-2] err'} <= set(screen.splitlines())
    assert '[INFO] [sh-1]: process started with pid [' in screen
    assert '[INFO] [sh-1]: process has finished cleanly [pid ' in screen


@pytest.mark.parametrize(
    ('output', 'screen_has', 'log_has'),
    [('screen', 'out err', ''), ('log', 'err', 'out err'), ('both', 'out err', 'out err')],
)
def test_output_goes_where_the_launch_file_says(output, screen_has, log_has, run):
    _, screen, log = run('echo out; echo err >&2', output=output)
    for word in ('out', 'err'):
        assert (f'[sh-1] {word}' in screen) == (word in screen_has)
        assert (f'[sh-1] {word}' in log) == (word in log_has)


def test_failure_of_a_process_is_that_of_the_launch(run):
    status, screen, _ = run('exit 3', 'exit 0')
    assert status == 1
    assert '[ERROR] [sh-1]: process has died [pid ' in screen
    assert ", exit code 3, cmd 'sh -c exit 3']." in screen


def test_command_that_cannot_run(tmp_path, capsys):
    spec = ProcessSpec('x-1', ('/no/such',), {})
    with LaunchLog(tmp_path) as log:
        assert asyncio.run(Supervisor(Plan([spec]), log).run()) == 1
    expected = "[ERROR] [x-1]: cannot run '/no/such': No such file or directory"
    assert expected in capsys.readouterr().out


def test_exit_of_one_process_can_end_the_launch(tmp_path, capsys):
    specs = [
        ProcessSpec('a-1', ('true',), dict(os.environ), shutdown_on_exit=True),
        ProcessSpec('b-2', ('sleep', '60'), dict(os.environ)),
    ]
    with LaunchLog(tmp_path) as log:
        assert asyncio.run(Supervisor(Plan(specs), log).run()) == 0
    assert "sending signal 'SIGINT' to process[b-2]" in capsys.readouterr().out


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
def test_interrupt_ends_the_processes_and_is_no_failure(number, run):
    # The launch is the parent of what it starts.
    status, screen, _ = run(f'kill -{int(number)} $PPID; sleep 60', 'sleep 60')
    assert status == 0
    assert '[WARNING] [launch]: user interrupted with ' in screen
    assert screen.count("sending signal 'SIGINT'") == 2


def test_stubborn_process_is_killed_with_its_children(run, tmp_path, monkeypatch):
    monkeypatch.setattr(supervisor, 'PATIENCE', 0.2)
    start = time.monotonic()
    script = f'trap "" INT TERM; sleep 61 & echo $! > {tmp_path}/pid; kill -INT $PPID; wait'
    status, screen, _ = run(script)
    assert time.monotonic() - start < 5.0
    assert status == 0
    assert "failed to terminate '0.2' seconds after receiving 'SIGTERM'" in screen
    child = Path('/proc', (tmp_path / 'pid').read_text().strip(), 'stat')
    assert not child.exists() or child.read_text().split()[2] == 'Z'


def test_child_left_behind_does_not_hold_up_the_launch(run):
    start = time.monotonic()
    status, _, _ = run('sleep 5 & echo done')
    assert status == 0
    assert time.monotonic() - start < 4.0


def test_log_directory_is_new_and_where_ros_says(tmp_path, monkeypatch):
    monkeypatch.setenv('ROS_LOG_DIR', str(tmp_path))
    first, second = make_log_directory(), make_log_directory()
    assert first != second
    assert first.parent == second.parent == tmp_path
