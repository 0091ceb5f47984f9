# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The robot's launch files: which processes they come to, and how they are wired."""

from __future__ import annotations

import os
from itertools import pairwise
from pathlib import Path

import pytest
from hexapod_sim.sensor_table import CHANNELS
from ros2_mini.launch.expand import expand_launch_file
from ros2_mini.launch.supervisor import ProcessSpec

LAUNCH = Path(__file__).resolve().parents[2] / 'ros_ws/src/hexapod_bringup/launch'
# The pattern generator's state is no device's.
DEVICE_TOPICS = [topic for c in CHANNELS for topic in c.topics if topic != 'cpg/state']


@pytest.fixture
def processes(tmp_path: Path):
    """Expand a launch file into its processes, by name of the node."""

    def expand(file: str, **arguments: str) -> dict[str, ProcessSpec]:
        arguments |= {'checkpoint': 'agent.pt'}
        plan = expand_launch_file(LAUNCH / file, arguments, dict(os.environ), tmp_path)
        return {word[8:]: p for p in plan.processes for word in p.command if '__node:=' in word}

    return expand


def parameters(process: ProcessSpec) -> str:
    """Return what is written in a process's parameter files."""
    files = [file for option, file in pairwise(process.command) if option == '--params-file']
    return '\n'.join(Path(file).read_text(encoding='utf-8') for file in files)


def test_a_robot_is_pattern_generator_and_agent_in_real_time(processes) -> None:
    robot = processes('robot.launch.xml')
    assert set(robot) == {'cpg', 'play'}
    assert all('sync: realtime' in parameters(process) for process in robot.values())
    assert all(process.shutdown_on_exit for process in robot.values())
    assert 'max_age.imu_data: 0.1' in parameters(robot['play'])


@pytest.mark.parametrize('topic', DEVICE_TOPICS)
def test_every_sensor_topic_is_an_argument(processes, topic: str) -> None:
    given = {topic.replace('/', '_'): '/my_driver/data'}
    play = processes('robot.launch.xml', **given)['play']
    assert f'{topic}:=/my_driver/data' in play.command
    others = [name for name in DEVICE_TOPICS if name != topic]
    assert all(f'{name}:={name}' in play.command for name in others)


def test_a_drivers_own_frame_is_an_argument(processes) -> None:
    play = processes('robot.launch.xml', frames='imu/data=bno055 body/height=tof')['play']
    assert 'frames: imu/data=bno055 body/height=tof' in parameters(play)
    assert "frames: ''" in parameters(processes('robot.launch.xml')['play'])


def test_the_pattern_generator_starts_from_the_joints_that_the_agent_hears(processes) -> None:
    robot = processes('robot.launch.xml', joint_states='/servos/state')
    assert 'joint_states:=/servos/state' in robot['cpg'].command
    assert 'joint_states:=/servos/state' in robot['play'].command
    assert 'start_from: measured' in parameters(robot['cpg'])


def test_the_servos_topic_is_an_argument(processes) -> None:
    cpg = processes('robot.launch.xml', joint_trajectory='/servos/goal')['cpg']
    assert 'joint_trajectory:=/servos/goal' in cpg.command


def test_in_lock_step_the_agent_node_hears_the_same_topics(processes) -> None:
    robot = processes('robot.launch.xml', sync='lockstep', imu_data='/bno055/data')
    assert set(robot) == {'cpg', 'play', 'agent'}
    remaps = [word for word in robot['play'].command if ':=' in word and '__' not in word]
    assert 'imu/data:=/bno055/data' in remaps
    assert set(remaps) <= set(robot['agent'].command)


def test_the_sim_takes_the_robots_place(processes) -> None:
    simulated = processes('simulated_robot.launch.xml', namespace='/r', real_time_factor='0.5')
    assert set(simulated) == {'sim', 'cpg', 'play'}
    assert all('__ns:=/r' in process.command for process in simulated.values())
    assert 'sync: realtime' in parameters(simulated['sim'])
    assert 'real_time_factor: 0.5' in parameters(simulated['sim'])
