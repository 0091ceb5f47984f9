# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Commands as processes of their own: exit statuses, signals, and nodes that a launch starts."""

import re
import signal
import subprocess
import sys
import time
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
  <executable cmd="sleep 60"/>
</group>"""


@SIGNALS
def test_launch_ends_what_it_started(number, prefix, start):
    prefix.add_executable('sample', NODE)
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
    path = prefix.add_launch_file('<executable cmd="false"/>')
    process = start('launch', str(path))
    assert '[ERROR] [false-1]: process has died' in process.communicate(timeout=20)[0]
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
    path = prefix.add_launch_file('<executable cmd="true"/>')
    process = start('launch', str(path), 'plam:=x')
    warning = "[WARNING] [launch]: no launch file declares the argument 'plam'"
    assert warning in process.communicate(timeout=20)[0]
    assert process.returncode == 0


@pytest.mark.usefixtures('sample')
class TestInterrupted:
    """Verbs that run until a signal ends them exit with its number, as upstream."""

    @SIGNALS
    @pytest.mark.parametrize(
        ('words', 'sign'),
        [
            (('topic', 'echo', '/chatter'), 'data: tick'),
            (('topic', 'hz', '/chatter'), 'average rate: '),
            (('topic', 'pub', '/x', 'std_msgs/msg/Bool', '-r', '50'), 'publishing #2'),
        ],
        ids=lambda words: words[1] if isinstance(words, tuple) else '',
    )
    def test_stream(self, words, sign, number, start):
        process = start(*words)
        read_until(process, sign)
        process.send_signal(number)
        process.communicate(timeout=20)
        assert process.returncode == number


def test_rate_of_a_topic_is_right(sample, start):
    process = start('topic', 'hz', '/chatter')
    lines = read_until(process, 'average rate: ')
    rate = float(lines[-1].split(': ')[1])
    assert rate == pytest.approx(20.0, rel=0.2)  # the sample's timer has 0.05 s; the host may lag
    process.send_signal(signal.SIGINT)
    process.wait(timeout=20)


def test_stopped_launch_waits_for_no_respawn(prefix, start):
    path = prefix.add_launch_file('<executable cmd="false" respawn="true" respawn_delay="60"/>')
    process = start('launch', str(path))
    read_until(process, 'process has died')
    begin = time.monotonic()
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=20)
    assert time.monotonic() - begin < 5.0
    assert process.returncode == 0
