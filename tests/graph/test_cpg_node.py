# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Node cpg: one command in, one trajectory of five points and one oscillator state out."""

from __future__ import annotations

import numpy as np
import pytest
from hexapod_cpg.cpg import Cpg
from hexapod_cpg.mapping import ActionRanges, command_from_action
from hexapod_cpg.nodes.cpg_node import CpgNode
from hexapod_cpg.nodes.messages import command_to_message
from hexapod_cpg.oscillator import HopfConfig
from hexapod_interfaces.msg import CpgCommand, CpgState
from hexapod_interfaces.srv import ResetEpisode
from hexapod_node.stamps import time_message, to_nanoseconds
from lifecycle_msgs.msg import Transition
from lifecycle_msgs.srv import ChangeState
from rcl_interfaces.srv import SetParametersAtomically
from rclpy.parameter import Parameter
from trajectory_msgs.msg import JointTrajectory

from hexapod_sim import robot

RANGES = ActionRanges.of_article()

pytestmark = pytest.mark.graph
START = 1_000_000_000
PERIOD = robot.CONTROL_PERIOD_NS
ACTION = np.linspace(-1.0, 1.0, 30, dtype=np.float32)


class Rig:
    """A pattern generator node with a commander and listeners."""

    def __init__(self, graph) -> None:
        self.graph = graph
        self.cpg = graph.add(CpgNode())
        self.trajectories: list[JointTrajectory] = []
        self.states: list[CpgState] = []
        node = graph.nodes[0]
        node.create_subscription(JointTrajectory, 'joint_trajectory', self.trajectories.append, 10)
        node.create_subscription(CpgState, 'cpg/state', self.states.append, 10)
        self.publisher = node.create_publisher(CpgCommand, 'cpg/command', 10)
        graph.until(lambda: self.publisher.get_subscription_count() == 1)
        request = ResetEpisode.Request(
            start=time_message(START),
            topics=['/joint_trajectory', '/cpg/state'],
            subscriptions=[1, 1],
        )
        while not graph.call(ResetEpisode, 'cpg/reset', request).success:
            graph.executor.spin_once(timeout_sec=0.01)
        graph.until(lambda: len(self.states) == 1)

    def command(self, stamp_ns: int, spoil=lambda message: None) -> None:
        message = CpgCommand()
        command_to_message(command_from_action(ACTION, 'D1', RANGES), message)
        message.header.stamp = time_message(stamp_ns)
        spoil(message)
        self.publisher.publish(message)


@pytest.fixture
def rig(graph) -> Rig:
    return Rig(graph)


def test_a_command_gives_the_trajectory_of_its_period_and_the_state_at_its_end(rig: Rig) -> None:
    rig.command(START)
    rig.graph.until(lambda: len(rig.trajectories) == 1 and len(rig.states) == 2)
    cpg = Cpg(HopfConfig.of_article())
    targets = cpg.advance(command_from_action(ACTION, 'D1', RANGES))
    (trajectory,) = rig.trajectories
    assert to_nanoseconds(trajectory.header.stamp) == START
    assert tuple(trajectory.joint_names) == robot.JOINTS
    times = [to_nanoseconds(point.time_from_start) for point in trajectory.points]
    assert times == [5_000_000, 10_000_000, 15_000_000, 20_000_000, 25_000_000]
    np.testing.assert_array_equal([list(point.positions) for point in trajectory.points], targets)
    assert [to_nanoseconds(state.header.stamp) for state in rig.states] == [START, START + PERIOD]
    np.testing.assert_array_equal(rig.states[1].x, cpg.x)
    np.testing.assert_array_equal(rig.states[1].y, cpg.y)


def test_in_lock_step_it_hears_nothing_but_commands(rig: Rig) -> None:
    heard = {subscription.topic_name for subscription in rig.cpg.subscriptions}
    assert heard - {'/parameter_events'} == {'/cpg/command'}


def test_a_command_that_is_not_due_is_counted_and_not_played(rig: Rig) -> None:
    rig.command(START + PERIOD)
    rig.command(START)
    rig.command(START)
    rig.graph.until(lambda: rig.cpg._mode._due.counts.duplicate == 1 and len(rig.states) == 2)
    assert rig.cpg._mode._due.counts.out_of_order == 1
    assert len(rig.trajectories) == 1


def test_a_command_with_nan_is_refused_by_name(rig: Rig) -> None:
    errors = []
    rig.cpg.get_logger().error = errors.append
    rig.command(START, lambda message: message.knee_bias.__setitem__(2, float('nan')))
    rig.graph.until(lambda: bool(errors))
    assert 'knee_bias' in errors[0]
    assert 'finite' in errors[0]
    rig.command(START)
    rig.graph.until(lambda: len(rig.trajectories) == 1)


def test_an_unknown_gait_is_refused(rig: Rig) -> None:
    gait = Parameter('cpg.gait', value='gallop').to_parameter_msg()
    request = SetParametersAtomically.Request(parameters=[gait])
    answer = rig.graph.call(SetParametersAtomically, 'cpg/set_parameters_atomically', request)
    assert not answer.result.successful
    assert 'gallop' in answer.result.reason
    assert 'tripod' in answer.result.reason


def change_state(rig: Rig, transition: int) -> bool:
    request = ChangeState.Request(transition=Transition(id=transition))
    return rig.graph.call(ChangeState, 'cpg/change_state', request).success


def test_inactive_it_answers_commands_with_the_way_to_the_standing_pose(rig: Rig) -> None:
    rig.command(START)
    rig.graph.until(lambda: len(rig.trajectories) == 1)
    assert change_state(rig, Transition.TRANSITION_DEACTIVATE)
    last = np.array(rig.trajectories[0].points[-1].positions)
    stamp, periods = START, 0
    while not np.array_equal(last, robot.NEUTRAL_POSE):
        stamp, periods = stamp + PERIOD, periods + 1
        rig.command(stamp)
        rig.graph.until(lambda: len(rig.trajectories) == periods + 1)  # noqa: B023
        targets = np.array([list(point.positions) for point in rig.trajectories[-1].points])
        # stop_rate is 0.5 rad/s, and targets are 5 ms apart.
        steps = np.abs(np.diff(targets, axis=0, prepend=last[None]))
        assert steps.max() <= 0.0025 * (1 + 1e-9)
        last = targets[-1]
    assert periods > 1


def test_inactive_it_refuses_an_episode_and_says_the_cure(rig: Rig) -> None:
    assert change_state(rig, Transition.TRANSITION_DEACTIVATE)
    response = rig.graph.call(ResetEpisode, 'cpg/reset', ResetEpisode.Request())
    assert not response.success
    assert response.message == 'cpg is not active: expected `ros2 lifecycle set cpg activate`'
    assert change_state(rig, Transition.TRANSITION_ACTIVATE)
    assert rig.graph.call(ResetEpisode, 'cpg/reset', ResetEpisode.Request()).success


def test_targets_stay_within_the_joint_limits_and_the_excess_is_counted(rig: Rig) -> None:
    rig.command(START, lambda message: message.knee_bias.fill(100.0))
    rig.graph.until(lambda: len(rig.trajectories) == 1)
    targets = np.array([list(point.positions) for point in rig.trajectories[0].points])
    assert (targets[:, 1::3] == robot.JOINT_UPPER[1]).all()
    assert dict(rig.cpg._health()[2])['beyond_limit'] == 1


def test_a_command_that_the_oscillators_cannot_follow_is_refused(rig: Rig) -> None:
    errors = []
    rig.cpg.get_logger().error = errors.append
    with np.errstate(all='ignore'):
        rig.command(START, lambda message: message.mu.fill(1e300))
        rig.graph.until(lambda: bool(errors))
    rig.command(START)
    rig.graph.until(lambda: len(rig.trajectories) == 1)
