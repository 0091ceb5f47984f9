# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Commands as processes of their own: exit statuses, signals, and nodes that a launch starts."""

import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.system

HERE = Path(__file__).resolve().parent
NODE = f'exec {sys.executable} {HERE / "sample_node.py"} "$@"'
SIGNALS = pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])


def read_until(process: subprocess.Popen, text: str) -> list[str]:
    """Return the lines of a process up to the first that holds `text`."""
    lines = []
    for line in process.stdout:
        lines.append(line)
        if text in line:
            return lines
    raise AssertionError(f'{text!r} is not in {lines}')


def is_running(pid: int) -> bool:
    stat = Path(f'/proc/{pid}/stat')
    return stat.exists() and stat.read_text().rpartition(')')[2].split()[0] != 'Z'


@SIGNALS
def test_run_becomes_the_executable(number, prefix, start):
    script = 'trap "exit 0" INT TERM; echo "$$: $@"; while :; do sleep 0.05; done'
    prefix.add_executable('waiting', script)
    process = start('run', 'demo', 'waiting', 'word', '--ros-args', '-r', '__ns:=/here')
    assert process.stdout.readline() == f'{process.pid}: word --ros-args -r __ns:=/here\n'
    process.send_signal(number)
    assert process.wait(timeout=20) == 0


def test_run_passes_on_the_exit_status_and_takes_a_prefix(prefix, start):
    prefix.add_executable('failing', 'exit 7')
    assert start('run', 'demo', 'failing').wait(timeout=20) == 7
    process = start('run', '--prefix', 'env A=5 sh -c', 'demo', 'failing')
    assert process.wait(timeout=20) == 7
    process = start('run', '--prefix', 'no_such_debugger', 'demo', 'failing')
    assert process.communicate(timeout=20)[0].startswith("cannot run 'no_such_debugger': No such")
    assert process.returncode == 1


LAUNCH = """<arg name="ns" default="a"/>
<group>
  <push-ros-namespace namespace="$(var ns)"/>
  <node pkg="demo" exec="sample" name="one" output="screen"><param name="count" value="9"/></node>
  <node pkg="demo" exec="sleeping"/>
</group>"""


@SIGNALS
def test_launch_ends_what_it_started(number, prefix, start):
    prefix.add_executable('sample', NODE)
    prefix.add_executable('sleeping', 'exec sleep 60')
    prefix.add_launch_file(LAUNCH)
    process = start('launch', 'demo', 'demo.launch.xml', 'ns:=b')
    lines = read_until(process, '[sample-1] sample is up')
    pids = [int(pid) for line in lines for pid in re.findall(r'started with pid \[(\d+)\]', line)]
    assert len(pids) == 2
    node = start('param', 'get', '/b/one', 'count')
    assert node.communicate(timeout=30)[0] == 'Integer value is: 9\n'
    process.send_signal(number)
    rest = process.communicate(timeout=30)[0]
    assert process.returncode == 0
    assert '[WARNING] [launch]: user interrupted with ' in rest
    assert '[INFO] [sample-1]: process has finished cleanly' in rest
    assert not any(map(is_running, pids))


def test_launch_fails_if_a_process_does(prefix, start):
    prefix.add_executable('failing', 'exit 1')
    path = prefix.add_launch_file('<node pkg="demo" exec="failing"/>')
    process = start('launch', str(path))
    assert '[ERROR] [failing-1]: process has died' in process.communicate(timeout=20)[0]
    assert process.returncode == 1


@pytest.mark.parametrize(
    ('body', 'arguments', 'message'),
    [
        ('<arg name="plan"/>', [], "required launch argument 'plan'"),
        ('<nod/>', [], '<nod> is not supported in <launch>; supported: arg'),
        ('', ['plan=x'], "malformed launch argument 'plan=x', expected format '<name>:=<value>'"),
    ],
)
def test_launch_that_cannot_start_says_why_in_one_line(body, arguments, message, prefix, start):
    path = prefix.add_launch_file(body)
    process = start('launch', str(path), *arguments)
    output = process.communicate(timeout=20)[0]
    assert message in output
    assert output.count('\n') == 1
    assert process.returncode == 1


def test_undeclared_argument_is_pointed_out(prefix, start):
    prefix.add_executable('fine', 'exit 0')
    path = prefix.add_launch_file('<node pkg="demo" exec="fine"/>')
    process = start('launch', str(path), 'plam:=x')
    warning = "[WARNING] [launch]: no launch file declares the argument 'plam'"
    assert warning in process.communicate(timeout=20)[0]
    assert process.returncode == 0


@SIGNALS
@pytest.mark.usefixtures('sample')
def test_echo_runs_until_a_signal_and_exits_with_its_number(number, start):
    process = start('topic', 'echo', '/chatter')
    read_until(process, 'data: tick')
    process.send_signal(number)
    process.communicate(timeout=20)
    assert process.returncode == number
