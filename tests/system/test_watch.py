# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""`watch` as a process: it serves a page beside a sim, ends well, and says what is wrong."""

from __future__ import annotations

import json
import re
import signal
import socket
from urllib.request import urlopen

import pytest

pytestmark = pytest.mark.system
SIM = (
    'ros2 run hexapod_sim sim_node --ros-args -r __ns:=/hall/w1 -p sync:=realtime '
    '-p real_time_factor:=0.2'
)


def test_it_shows_a_robot_and_ends_with_status_0(shell) -> None:
    shell.start(SIM)
    watch = shell.start('ros2 run hexapod_bringup watch --port 0 --ros-args -r __ns:=/hall')
    shell.until(lambda: 'watch: open http' in shell.output())
    address = re.search(r'watch: open (\S+) in a browser', shell.output())[1]
    assert address.startswith('http://127.0.0.1:')
    found = {}
    with urlopen(f'{address}events?robot=w1', timeout=30) as stream:
        for line in stream:
            if line.startswith(b'data: '):
                told = json.loads(line.removeprefix(b'data: '))
                found |= {key: told[key] for key in ('picture', 'outcome') if told.get(key)}
                found |= told.get('samples', {})
            if {'joint_states', 'step_outcome', 'outcome', 'picture'} <= found.keys():
                break
        assert len(found['joint_states']['v'][0]) == 18
        watch.send_signal(signal.SIGINT)  # while a page is open
        assert watch.wait(20.0) == 0, shell.output()
    assert 'Traceback' not in shell.output()


def test_what_it_cannot_do_is_one_line(shell) -> None:
    with socket.socket() as taken:
        taken.bind(('127.0.0.1', 0))
        taken.listen()
        port = taken.getsockname()[1]
        ended = shell.run(f'ros2 run hexapod_bringup watch --port {port}')
    assert ended.returncode == 2
    assert f'127.0.0.1:{port}' in ended.stderr
    assert '--port 0 takes any' in ended.stderr
    assert ended.stderr.count('\n') == 1
    ended = shell.run('ros2 run hexapod_bringup watch .')
    assert ended.returncode == 2
    assert 'plan.csv' in ended.stderr
