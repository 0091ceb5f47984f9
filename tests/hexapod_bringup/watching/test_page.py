# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The watch page: what it serves to whom, and how a real browser draws it."""

from __future__ import annotations

import io
import json
import math
from collections.abc import Iterator
from contextlib import contextmanager
from http.client import HTTPConnection
from pathlib import Path
from typing import Any

import pytest
from browser import OVERFLOW, Browser, in_every_look, needs_browser
from hexapod_bringup.watching.board import OUTCOME, Board, Robot, Seen
from hexapod_bringup.watching.server import PageServer
from hexapod_bringup.watching.signals import JOINT_STATES, SIGNALS
from PIL import Image

CAMPAIGN = Path(__file__).resolve().parents[3] / 'bags' / 'sample_campaign'
TERMS = {'velocity': 0.4, 'closeness': 3.1, 'orientation': -0.2, 'height': -0.05, 'alive': 1.0}
BACKGROUNDS = {'light': 'rgb(254, 254, 254)', 'dark': 'rgb(18, 22, 28)'}
PAINTED = """
const painted = canvas => {
  const pen = canvas.getContext('2d');
  return pen.getImageData(0, 0, canvas.width, canvas.height).data.some(value => value > 0);
};
const shown = [...document.querySelectorAll('canvas')].filter(c => c.getClientRects().length);
return {shown: shown.length, blank: shown.filter(c => !painted(c)).map(c => c.ariaLabel)};
"""


class Pictures:
    """A studio that has one picture of every robot."""

    fault = ''

    def __init__(self) -> None:
        picture = io.BytesIO()
        Image.new('RGB', (480, 320), (90, 120, 150)).save(picture, 'JPEG')
        self._picture = picture.getvalue()

    def picture(self, name: str) -> bytes:
        return self._picture


def walked(name: str = 'w1') -> Robot:
    """Return a robot that has walked for two seconds, after six episodes."""
    robot = Robot(name, heard=('imu/data', JOINT_STATES), speed=12.5)
    for step in range(80):
        for topic, signal in SIGNALS.items():
            values = [math.sin(step / 5 + number) for number in range(len(signal.labels))]
            robot.track(topic).add(step * 0.025, values)
        robot.track(OUTCOME).add(step * 0.025, [*TERMS.values(), sum(TERMS.values())])
    robot.outcome = {'step': 79, 'reward': 4.25, 'terms': TERMS, 'cause': '', 'time': 1.975}
    for episode in range(6):
        robot.add_episode(
            {'run': 'run_3', 'episode': episode, 'steps': 600, 'return': 100.0 + episode**2,
             'average': 100.0 + episode, 'cause': '', 'terms': {'velocity': 10.0 + episode},
             'metrics': {'critic_loss': None if episode == 0 else 1.0 / episode}}
        )  # fmt: skip
    return robot


@contextmanager
def served(*robots: Robot, host: str = '127.0.0.1') -> Iterator[PageServer]:
    board = Board()
    board.robots = {robot.name: robot for robot in robots}
    board.campaign_folder = str(CAMPAIGN)
    server = PageServer(host, 0, board, Pictures())
    server.start()
    try:
        yield server
    finally:
        server.close()


@pytest.fixture
def server() -> Iterator[PageServer]:
    with served(walked('w1'), walked('w2')) as made:
        yield made


def get(server: PageServer, path: str, **headers: str) -> Any:
    connection = HTTPConnection(*server.server_address[:2], timeout=10)
    connection.request('GET', path, headers=headers)
    return connection.getresponse()


def first_event(server: PageServer, path: str) -> dict[str, Any]:
    answer = get(server, path)
    line = answer.readline()
    answer.close()
    return json.loads(line.removeprefix(b'data: '))


def test_a_page_is_told_everything_once_and_then_what_is_new() -> None:
    board, seen = Board(), Seen()
    robot = board.robots['w1'] = walked()
    told = board.news('w1', seen)
    assert set(told['samples']) == {*SIGNALS, OUTCOME}
    assert len(told['episodes']) == 6
    again = board.news('w1', seen)
    assert (again['samples'], again['episodes']) == ({}, [])
    robot.track(JOINT_STATES).add(3.0, [math.nan] * 18)
    (track,) = board.news('w1', seen)['samples'].values()
    assert track == {'t': [3.0], 'v': [[None] * 18]}
    assert json.dumps(told, allow_nan=False)


def test_a_robot_is_heard_while_a_page_looks_at_it() -> None:
    board = Board()
    assert board.watched() == {}
    with board.watching('w1', every=False), board.watching('w1', every=True):
        assert board.watched() == {'w1': True}
    assert board.watched() == {}


def test_events_hold_picture_samples_and_campaign(server: PageServer) -> None:
    event = first_event(server, '/events?robot=w2')
    assert (event['robot'], event['robots']) == ('w2', ['w1', 'w2'])
    assert event['outcome']['terms'] == TERMS
    assert event['picture']
    assert event['campaign']['name'] == 'sample_campaign'
    assert len(event['campaign']['runs']) == 8
    assert {panel['name'] for panel in event['panels']} >= {'foot forces', 'body orientation'}


def test_a_robot_that_is_not_there_is_no_error(server: PageServer) -> None:
    event = first_event(server, '/events?robot=gone')
    assert event['robots'] == ['w1', 'w2']
    assert 'samples' not in event


def test_pages_of_elsewhere_are_refused(server: PageServer) -> None:
    """A name of theirs may lead to this machine: what the browser asks for tells."""
    assert get(server, '/', Host='evil.example').status == 403
    assert get(server, '/events', Host='evil.example:80').status == 403
    assert get(server, '/', Host='localhost:1234').status == 200
    assert get(server, '/../watch.py').status == 404


def test_the_page_may_run_its_own_script_alone(server: PageServer) -> None:
    rules = get(server, '/').getheader('Content-Security-Policy')
    assert "default-src 'none'" in rules
    assert 'unsafe' not in rules
    assert 'http' not in rules


def test_a_campaign_that_cannot_be_read_is_told(tmp_path: Path) -> None:
    with served(walked()) as server:
        server.board.campaign_folder = str(tmp_path)
        assert 'plan.csv' in first_event(server, '/events?robot=w1')['campaign']['fault']


@needs_browser
@in_every_look
def test_the_page_is_drawn(browser: Browser, server: PageServer, width: int, theme: str) -> None:
    browser.open(server.address, width, theme)
    browser.wait_for("document.querySelector('#link.live') && document.querySelector('#film').src")
    browser.wait_for("document.querySelectorAll('#table tbody tr').length === 8")
    browser.wait_for(
        "document.querySelector('#curves canvas') && !document.querySelector('#learning').hidden"
    )
    found = browser.run(PAINTED)
    assert found['shown'] >= 18
    assert found['blank'] == []
    assert browser.run(f'return {OVERFLOW};') <= 0
    look = 'return getComputedStyle(document.body).backgroundColor;'
    assert browser.run(look) == BACKGROUNDS[theme]
    assert browser.run("return document.querySelector('#film').naturalWidth;") == 480
    assert browser.run("return document.querySelector('#episode').textContent;") == '6'
    assert browser.complaints() == []
    assert all(each.startswith(server.address) for each in browser.requests())
    browser.open('about:blank', width, theme)


@needs_browser
def test_another_robot_can_be_chosen(browser: Browser, server: PageServer) -> None:
    browser.open(server.address, 1280, 'light')
    browser.wait_for("document.querySelectorAll('#robot option').length === 2")
    browser.run(
        "const s = document.querySelector('#robot'); s.value = 'w2';"
        "s.dispatchEvent(new Event('change'));"
    )
    browser.wait_for("document.querySelector('#film').src && state.robot === 'w2'")
    assert server.board.watched().keys() >= {'w2'}
    assert browser.complaints() == []
    browser.open('about:blank', 1280, 'light')


@needs_browser
@pytest.mark.parametrize('width', [1280, 390])
def test_without_a_robot_the_page_says_what_to_start(browser: Browser, width: int) -> None:
    with served() as server:
        browser.open(server.address, width, 'light')
        browser.wait_for("!document.querySelector('#none').hidden")
        assert 'follow.launch.xml' in browser.run(
            "return document.querySelector('#none').innerText;"
        )
        assert browser.run(f'return {OVERFLOW};') <= 0
        assert browser.complaints() == []
        browser.open('about:blank', width, 'light')
