# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The bag that comes with the repository passes, whole or renamed, and what it lacks is named."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from hexapod_agent.observation import LETTERS
from hexapod_doe.check_sensors_node import main

BAG = str(Path(__file__).resolve().parents[3] / 'bags/sample')


def checked(capsys, *options: str) -> tuple[int, dict]:
    """Return exit status and outcome of a check of the bag."""
    with pytest.raises(SystemExit) as ended:
        main(['--bag', BAG, '--json', '-', *options])
    return int(ended.value.code), json.loads(capsys.readouterr().out)


def test_a_recorded_walk_passes_on_every_channel(capsys) -> None:
    status, outcome = checked(capsys, '--observations', LETTERS)
    assert status == 0
    assert outcome['findings'] == []
    assert {round(row['rate'], 6) for row in outcome['topics']} == {40.0}
    assert len(outcome['topics']) == 15


def test_a_driver_s_own_name_is_given_by_a_remapping(capsys) -> None:
    """Angular velocities are also in imu/data: either topic does."""
    status, outcome = checked(capsys, '--observations', 'D', '-r', 'imu/data_raw:=imu/data')
    assert status == 0
    assert outcome['topics'][-1]['topic'] == '/hexapod/imu/data'


def test_a_topic_of_another_type_is_named(capsys) -> None:
    status, outcome = checked(capsys, '--observations', 'E', '-r', 'body/height:=odom')
    assert status == 1
    (fault,) = outcome['findings']
    assert fault['kind'] == 'wrong_type'
    assert fault['found'] == 'is of type nav_msgs/msg/Odometry'


def test_a_frame_is_wrong_unless_it_is_the_one_that_was_asked_for(capsys) -> None:
    """The option turns the table's own frame into a wrong one: what is asked for holds."""
    options = ('--observations', 'C', '--frames', 'imu/data=bno055')
    status, outcome = checked(capsys, *options)
    assert status == 1
    assert [fault['kind'] for fault in outcome['findings']] == ['wrong_frame']


@pytest.mark.parametrize(
    ('options', 'complaint'),
    [
        (['--bag', '/no/bag', '--observations', 'A'], 'bag /no/bag: no such directory'),
        (['--bag', BAG, '--observations', 'A', '-r', 'joint_torques:=x'], "topic 'x' expected"),
    ],
)
def test_what_cannot_be_read_is_one_clear_line(options: list[str], complaint: str) -> None:
    with pytest.raises(SystemExit, match=complaint):
        main(options)


@pytest.mark.parametrize(
    ('options', 'complaint'),
    [
        (['--observations', 'AX'], "unknown letter 'X'"),
        (['--observations', 'A', '--frames', 'imu'], "frames 'imu': expected <topic>=<frame>"),
        (['--observations', 'A', '-r', 'x'], "remap 'x': expected <topic>:=<other>"),
        (['--observations', 'A', '--seconds', '0'], 'expected a positive number'),
    ],
)
def test_a_wrong_option_is_named(capsys, options: list[str], complaint: str) -> None:
    with pytest.raises(SystemExit) as ended:
        main(options)
    assert ended.value.code == 2
    assert complaint in capsys.readouterr().err
