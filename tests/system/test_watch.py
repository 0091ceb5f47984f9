# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""`watch` as a process: it serves a page beside a sim, ends well, and says what is wrong."""

from __future__ import annotations

import json
import re
import signal
import socket
from collections.abc import Iterator
from typing import Any
from urllib.request import urlopen

import pytest

from .short_campaign import TWO_RUNS, ShortCampaign

pytestmark = pytest.mark.system
SIM = (
    'ros2 run hexapod_sim sim_node --ros-args -r __ns:=/hall/w1 -p sync:=realtime '
    '-p real_time_factor:=0.2'
)


def address_of(shell) -> str:
    """Return where the watch says that its page is."""
    shell.until(lambda: 'in a browser' in shell.output())
    found = re.search(r'watch: open (http://127\.0\.0\.1:\d+/) in a browser', shell.output())
    assert found
    return found[1]


def events(address: str, query: str = '') -> Iterator[dict[str, Any]]:
    """Yield what a page is told, for as long as it asks."""
    with urlopen(f'{address}events?{query}', timeout=30) as stream:
        for line in stream:
            if line.startswith(b'data: '):
                yield json.loads(line.removeprefix(b'data: '))


def test_it_shows_a_robot_and_ends_with_status_0(shell) -> None:
    shell.start(SIM)
    watch = shell.start('ros2 run hexapod_bringup watch --port 0 --ros-args -r __ns:=/hall')
    found: dict[str, Any] = {}
    page = events(address_of(shell), 'robot=w1')
    while not {'joint_states', 'step_outcome', 'outcome', 'picture'} <= found.keys():
        told = next(page)
        found |= {key: told[key] for key in ('picture', 'outcome') if told.get(key)}
        found |= told.get('samples', {})
    assert len(found['joint_states']['v'][0]) == 18
    watch.send_signal(signal.SIGINT)  # while a page is open
    assert watch.wait(20.0) == 0, shell.output()
    page.close()
    assert 'Traceback' not in shell.output()


@pytest.mark.slow
def test_a_campaign_that_is_watched_gives_the_same_numbers(shell) -> None:
    campaign = ShortCampaign(shell, shell.directory / 'campaign', TWO_RUNS, episodes=60)
    shell.start('ros2 run hexapod_bringup watch --port 0')
    address = address_of(shell)
    manager = campaign.start(workers=1)
    page = events(address)
    robot = next(told['robots'][0] for told in page if told['robots'])
    page.close()
    found: dict[str, Any] = {}
    for told in events(address, f'robot={robot}&every=1'):
        found |= told.get('samples', {})
        found |= {'episodes': told['episodes']} if told.get('episodes') else {}
        found |= {'campaign': told['campaign']} if told.get('campaign') else {}
        if manager.poll() is not None:
            break
    assert manager.wait() == 0, shell.output()
    campaign.assert_as_alone()
    assert {'joint_states', 'foot_force/lf', 'step_outcome', 'episodes'} <= found.keys()
    assert len(found['campaign']['runs']) == 2


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
