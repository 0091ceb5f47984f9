# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The bag that comes with the repository passes, whole or renamed, and what it lacks is named."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from hexapod_agent.specification.observation import ObservationSpec
from hexapod_doe.bags.bag_file import BagFile
from hexapod_doe.nodes.check_sensors_node import main
from hexapod_sim.sensor_table import CHANNELS

CASES = Path(__file__).resolve().parents[2] / 'data/cases'
TWO = str(CASES / 'b05_two_robots')
BAG = str(Path(__file__).resolve().parents[3] / 'bags/sample')


def checked(capsys, *options: str, bag: str = BAG) -> tuple[int, dict]:
    """Return exit status and outcome of a check of the bag."""
    with pytest.raises(SystemExit) as ended:
        main(['--bag', bag, '--json', '-', *options])
    return int(ended.value.code), json.loads(capsys.readouterr().out)


def test_a_recorded_walk_passes_on_every_channel(capsys) -> None:
    topics = {topic.removeprefix('/hexapod/') for topic in BagFile(BAG).types}
    letters = ''.join(channel.letter for channel in CHANNELS if topics.issuperset(channel.topics))
    assert set('ABCDEFG') <= set(letters)
    status, outcome = checked(capsys, '--observations', letters)
    assert status == 0
    assert outcome['findings'] == []
    assert {round(row['rate'], 6) for row in outcome['topics']} == {40.0}
    assert len(outcome['topics']) == len(ObservationSpec(letters).topics)


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
        (['--bag', str(CASES), '--observations', 'A'], 'bags below it, expected a bag itself'),
        (['--bag', TWO, '--observations', 'D'], 'is there twice: /robot1/joint_states, /robot2/'),
        (['--bag', TWO, '--observations', 'D'], 'choose one: -r __ns:=/robot1 for all topics'),
        (
            ['--bag', TWO, '--observations', 'D', '-r', '__ns:=/robot3'],
            'no topic of the set in /robot3, expected /robot1, /robot2',
        ),
    ],
)
def test_what_cannot_be_read_is_one_clear_line(capsys, options: list[str], complaint: str) -> None:
    with pytest.raises(SystemExit) as ended:
        main(options)
    assert ended.value.code == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert complaint in line


@pytest.mark.parametrize(
    ('options', 'complaint'),
    [
        (['--observations', 'AX'], "unknown letter 'X'"),
        (['--observations', 'A', '--frames', 'imu'], "frames 'imu': expected <topic>=<frame>"),
        (['--observations', 'A', '-r', 'x'], "remap 'x': expected <topic>:=<other>"),
        (
            ['--observations', 'A', '-r', 'imu/dat:=/x'],
            "did you mean 'imu/data'?",
        ),
        (['--observations', 'A', '-r', 'gps:=/x'], 'expected one of joint_states, '),
        (['--observations', 'A', '-r', '__ns:=x'], "expected a namespace that begins with '/'"),
        (
            ['--observations', 'A', '--bag', BAG, '--ros-args', '-p', 'x:=1'],
            "'-p' after --ros-args: expected -r <topic>:=<other> for a bag",
        ),
        (['--observations', 'A', '--seconds', '0'], 'expected a positive number'),
    ],
)
def test_a_wrong_option_is_named(capsys, options: list[str], complaint: str) -> None:
    with pytest.raises(SystemExit) as ended:
        main(options)
    assert ended.value.code == 2
    assert complaint in capsys.readouterr().err


@pytest.mark.parametrize('case', ['plain_ok', 'plain_ok/plain_0.mcap', 'b02_file_zstd'])
def test_a_bag_passes_however_it_is_stored(capsys, case: str) -> None:
    status, outcome = checked(capsys, '--observations', 'D', bag=str(CASES / case))
    assert (status, outcome['passed']) == (0, True)


@pytest.mark.parametrize(
    'rule', [['-r', '__ns:=/robot2'], ['--ros-args', '--remap', '__ns:=/robot2']]
)
def test_one_of_two_robots_is_chosen_by_its_namespace(capsys, rule: list[str]) -> None:
    status, outcome = checked(capsys, '--observations', 'D', *rule, bag=TWO)
    assert status == 0
    assert {row['topic'].split('/')[1] for row in outcome['topics']} == {'robot2'}


@pytest.mark.parametrize(
    ('case', 'letters', 'kind', 'cure'),
    [
        ('d01_nan_velocity', '', 'not_finite', "export the state interface 'velocity'"),
        ('d02_no_angular_velocity', 'D', 'not_measured', 'take a device that measures it'),
        ('d04_two_publishers', '', 'many_publishers', 'stop all of them but one'),
    ],
)
def test_a_fault_of_the_device_is_the_one_thing_named(
    capsys, case: str, letters: str, kind: str, cure: str
) -> None:
    status, outcome = checked(capsys, '--observations', letters, bag=str(CASES / case))
    assert status == 1
    (fault,) = outcome['findings']
    assert fault['kind'] == kind
    assert cure in fault['cure']
