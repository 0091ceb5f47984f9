# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Sim, pattern generator and a deployed agent in real time: they walk, and stop safely."""

from __future__ import annotations

import time

import numpy as np
import pytest
from diagnostic_msgs.msg import DiagnosticArray
from hexapod_agent.learning import checkpoint
from hexapod_agent.learning.training import Trainer
from hexapod_agent.nodes import real_time
from hexapod_agent.nodes.play_node import PlayNode
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_cpg.locomotion import Motion
from hexapod_cpg.nodes.cpg_node import CpgNode
from hexapod_node.stamps import to_nanoseconds
from hexapod_sim.nodes.sim_node import SimNode
from lifecycle_msgs.msg import State, Transition
from lifecycle_msgs.srv import ChangeState, GetState
from nav_msgs.msg import Odometry
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory

from hexapod_sim import robot

pytestmark = pytest.mark.graph
STOP_RATE = 0.5
SMALL = {'actor': {'hidden': [16, 12]}, 'critic': {'hidden': [16, 12]}}
# A busy machine may hold up a whole process: ages that no pause of it reaches.
AGES = [f'{p.name}:=1.0' for p in real_time.PARAMETERS if p.name.startswith('max_age')]


@pytest.fixture
def ros_args(tmp_path) -> list[str]:
    """Return arguments for real time and an untrained agent of the channels C and F."""
    trainer = Trainer(RunSpec.from_mapping(SMALL, 'small').observing('CF'), 5)
    checkpoint.save_agent(tmp_path / 'agent.pt', trainer)
    given = ['sync:=realtime', f'checkpoint:={tmp_path}/agent.pt', 'check_seconds:=0.2', *AGES]
    given += ['max_age:=1.0']
    return ['--ros-args', *(word for value in given for word in ('-p', value))]


class Robot:
    """The three nodes, and what they say."""

    def __init__(self, graph) -> None:
        self.graph = graph
        self.trajectories: list[JointTrajectory] = []
        self.values: dict[str, dict[str, str]] = {}
        self.x = 0.0
        node = graph.nodes[0]
        node.create_subscription(JointTrajectory, 'joint_trajectory', self.trajectories.append, 10)
        node.create_subscription(DiagnosticArray, '/diagnostics', self._on_diagnostics, 10)
        node.create_subscription(Odometry, 'odom', self._on_odometry, 10)
        self.sim = graph.add(SimNode())
        self.cpg = graph.add(CpgNode())
        self.play = graph.add(PlayNode())

    def _on_diagnostics(self, message: DiagnosticArray) -> None:
        for status in message.status:
            name = status.name.removeprefix('/').removesuffix(': state')
            self.values[name] = {entry.key: entry.value for entry in status.values}

    def _on_odometry(self, message: Odometry) -> None:
        self.x = message.pose.pose.position.x

    def until(self, node: str, key: str, value: str) -> None:
        self.graph.until(lambda: self.values.get(node, {}).get(key) == value)

    def until_it_is(self, motion: Motion) -> int:
        """Wait for a motion of the legs; return how many trajectories had come by then."""
        self.graph.until(lambda: self.cpg._locomotion.motion is motion)
        return len(self.trajectories) + 2  # what was under way still comes

    def positions(self) -> np.ndarray:
        """Return every joint target so far (periods, SUBSTEPS, 18)."""
        return np.array([[list(p.positions) for p in t.points] for t in self.trajectories])

    def change(self, transition: int) -> bool:
        request = ChangeState.Request(transition=Transition(id=transition))
        return self.graph.call(ChangeState, 'cpg/change_state', request).success

    def state(self) -> int:
        return self.graph.call(GetState, 'cpg/get_state', GetState.Request()).current_state.id


@pytest.fixture
def walking(graph) -> Robot:
    """Return a robot on its way."""
    made = Robot(graph)
    made.until('play', 'state', 'driving')
    graph.until(lambda: made.x > 0.02)
    return made


def assert_stands(walking: Robot, since: int) -> None:
    """Assert that the robot came to its standing pose, slowly, and stays there."""
    ended = walking.until_it_is(Motion.STANDING)
    walking.graph.until(lambda: len(walking.trajectories) > ended + 2)
    targets = walking.positions()[since:].reshape(-1, 18)
    assert np.abs(np.diff(targets, axis=0)).max() <= STOP_RATE * 0.005 * (1 + 1e-9)
    np.testing.assert_array_equal(targets[-1], robot.NEUTRAL_POSE)


def test_the_robot_walks_and_every_node_says_how_late_it_ticks(walking: Robot) -> None:
    walking.graph.until(lambda: len(walking.values) == 3)
    for name in ('sim', 'cpg', 'play'):
        values = walking.values[name]
        assert int(values['ticks']) > 0
        assert float(values['lateness_median_ms']) <= float(values['lateness_max_ms'])
    assert float(walking.values['play']['imu/data.age_ms']) <= 1000.0
    assert walking.values['play']['foot_force/rr.invalid'] == '0'
    heard = {subscription.topic_name for subscription in walking.play.subscriptions}
    assert {'/imu/data', '/foot_force/rr', '/joint_states'} < heard
    assert not heard & {'/joint_torques', '/body/twist', '/step_outcome', '/odom'}


def test_silent_sensors_lead_to_a_slow_stop_and_new_ones_to_a_walk(walking: Robot) -> None:
    walking.sim._real_time._ticker.destroy()
    walking.until('play', 'state', 'holding')
    assert_stands(walking, walking.until_it_is(Motion.STOPPING))
    walking.until('cpg', 'motion', 'standing')
    assert walking.values['play']['holds'] == '1'
    walking.graph.add(SimNode())
    walking.until('play', 'state', 'driving')
    walking.until_it_is(Motion.WALKING)


def test_inactive_brings_the_robot_to_stand(walking: Robot) -> None:
    assert walking.state() == State.PRIMARY_STATE_ACTIVE
    assert walking.change(Transition.TRANSITION_DEACTIVATE)
    since = walking.until_it_is(Motion.STOPPING)
    assert not walking.change(Transition.TRANSITION_CLEANUP)  # it does not stand yet
    assert walking.state() == State.PRIMARY_STATE_INACTIVE
    assert_stands(walking, since)
    assert walking.change(Transition.TRANSITION_ACTIVATE)
    walking.until_it_is(Motion.WALKING)


@pytest.mark.alone
def test_a_stall_is_caught_up_with_and_told(graph) -> None:
    stamps: list[int] = []
    warnings: list[str] = []
    graph.nodes[0].create_subscription(
        JointState, 'joint_states', lambda m: stamps.append(to_nanoseconds(m.header.stamp)), 100
    )
    sim = graph.add(SimNode())
    sim.get_logger().warning = lambda text, **_: warnings.append(text)
    graph.until(lambda: len(stamps) > 5)
    before = stamps[-1]
    time.sleep(0.2)
    graph.until(lambda: stamps[-1] - before > 300_000_000)
    assert 'behind real time by' in warnings[0]
    values = dict(sim._real_time.health()[2])
    assert values['caught_up_periods'] >= 7
    assert values['skipped_periods'] == 0
    gaps = np.diff([stamp for stamp in stamps if stamp >= before])
    assert (gaps > 0).all()
    assert len(gaps) >= 12  # 0.3 s of 25 ms, the stall included


def test_a_missing_sensor_is_refused_by_name(graph) -> None:
    graph.add(CpgNode())
    play = graph.add(PlayNode())
    graph.until(lambda: dict(play._play.health()[2])['state'] == 'refused')
    text = play._play.health()[1]
    assert 'imu/data' in text
    assert 'foot_force/lf' in text
    assert 'body/twist' not in text
