# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A sensor is swapped, checked, broken and checked again, by the lines that a user types."""

from __future__ import annotations

import json

import pytest
from rclpy.node import Node

pytestmark = pytest.mark.system
DRIVER = (
    'ros2 run hexapod_sim fake_driver --ros-args -r __ns:=/robot -p channel:=imu/data '
    '-p topic:=bno055/data -p frame:=bno055 -p noise:=0.01'
)
CHECK = (
    'ros2 run hexapod_doe check_sensors --observations C -r imu/data:=bno055/data '
    '-r __ns:=/robot --seconds 1 --max-age 1.0 --json found.json'
)


def checked(shell, *options: str) -> tuple[int, list[tuple[str, str]], str]:
    """Return exit status, faults by kind and field, and what was printed."""
    ended = shell.run(' '.join([CHECK, *options]))
    found = json.loads((shell.directory / 'found.json').read_text())
    faults = [(f['kind'], f['field']) for f in found['findings'] if f['level'] == 'fault']
    return ended.returncode, faults, ended.stdout


def test_a_driver_is_checked_before_the_robot_moves(shell, observer: Node) -> None:
    for node in ('hexapod_sim sim_node', 'hexapod_cpg cpg_node'):
        shell.start(f'ros2 run {node} --ros-args -r __ns:=/robot -p sync:=realtime')
    shell.start(DRIVER)
    shell.until(lambda: '/robot/bno055/data' in dict(observer.get_topic_names_and_types()))

    status, faults, printed = checked(shell)
    assert (status, faults) == (1, [('wrong_frame', 'header.frame_id')]), printed
    assert "fault /robot/bno055/data: header.frame_id is 'bno055'" in printed
    assert 'cure: ' in printed

    frames = '--frames imu/data=bno055'
    assert checked(shell, frames)[:2] == (0, [])

    shell.run('ros2 param set /robot/fake_driver fault nan')
    assert checked(shell, frames)[:2] == (1, [('not_finite', 'orientation[0]')])
