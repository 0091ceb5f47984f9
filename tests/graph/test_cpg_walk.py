# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A seeded random walk over everything that can happen to the pattern generator in real time.

The time is the test's own. The walk holds the node against a model of the managed node's states
and checks each trajectory as it leaves: finite, within limits and rates, of the tick that is due.
"""

from __future__ import annotations

import time
from collections import Counter

import numpy as np
import pytest
from diagnostic_msgs.msg import DiagnosticStatus
from hexapod_cpg.locomotion import Motion
from hexapod_cpg.mapping import COMMAND_FIELDS, ActionRanges, command_from_action
from hexapod_cpg.nodes.cpg_node import CpgNode
from hexapod_cpg.nodes.messages import command_to_message
from hexapod_interfaces.msg import CpgCommand
from hexapod_node.stamps import time_message, to_nanoseconds
from lifecycle_msgs.msg import Transition
from lifecycle_msgs.srv import ChangeState, GetState
from rclpy.parameter import Parameter
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory

from hexapod_sim import robot

RANGES = ActionRanges.of_article()

pytestmark = pytest.mark.graph
PERIOD = robot.CONTROL_PERIOD_NS
SECOND = 1_000_000_000
STOP_RATE = 2.0
MAX_STEP = robot.NO_LOAD_SPEED * 0.005
STOP_STEP = STOP_RATE * 0.005
ROUNDING = 1 + 1e-9
# Longest that a busy machine may hold up a tick before the test takes it for one that is not due.
WAIT_S = 0.2

# The states of a managed node that requests lead from and to.
NEXT = {
    ('unconfigured', Transition.TRANSITION_CONFIGURE): 'inactive',
    ('inactive', Transition.TRANSITION_ACTIVATE): 'active',
    ('active', Transition.TRANSITION_DEACTIVATE): 'inactive',
    ('inactive', Transition.TRANSITION_CLEANUP): 'unconfigured',
    ('unconfigured', Transition.TRANSITION_UNCONFIGURED_SHUTDOWN): 'finalized',
    ('inactive', Transition.TRANSITION_INACTIVE_SHUTDOWN): 'finalized',
    ('active', Transition.TRANSITION_ACTIVE_SHUTDOWN): 'finalized',
}
REQUESTS = [*range(8), 50, 99, 255]
AT_REST = (Motion.STANDING, Motion.WAITING)


@pytest.fixture
def ros_args() -> list[str]:
    given = ['sync:=realtime', 'max_age:=0.2', f'stop_rate:={STOP_RATE}', 'autostart:=false']
    return ['--ros-args', *(word for value in given for word in ('-p', value))]


class Walk:
    """A pattern generator in a time of the test's own, and a model of what it may do."""

    def __init__(self, graph, seed: int, start_from: str) -> None:
        self.graph = graph
        self.random = np.random.default_rng(seed)
        self.done: Counter[str] = Counter()
        self.now_ns = 1000 * SECOND
        self.state = 'unconfigured'
        self.measured = start_from == 'measured'
        self.last = robot.NEUTRAL_POSE
        helper = graph.nodes[0]
        self._clock = helper.create_publisher(Clock, '/clock', 10)
        self._commander = helper.create_publisher(CpgCommand, 'cpg/command', 10)
        self._driver = helper.create_publisher(JointState, 'joint_states', 10)
        self._change = helper.create_client(ChangeState, 'cpg/change_state')
        self._state = helper.create_client(GetState, 'cpg/get_state')
        given = {'use_sim_time': True, 'start_from': start_from}
        self.cpg = graph.add(CpgNode([Parameter(name, value=v) for name, v in given.items()]))
        trajectories = self.cpg._mode._trajectory
        self._publish = trajectories.publish
        trajectories.publish = self._check
        graph.until(
            lambda: (
                self._commander.get_subscription_count() == 1
                and self._clock.get_subscription_count() == 1
                and self._change.service_is_ready()
                and self._state.service_is_ready()
            )
        )
        self._set_time(self.now_ns)

    @property
    def motion(self) -> Motion:
        return self.cpg._locomotion.motion

    def step(self) -> None:
        """Let one thing happen, then mostly a tick."""
        kinds = ['command', 'request', 'joints', 'stall', 'back', 'ahead', 'nothing']
        shares = [0.72, 0.08, 0.12, 0.03, 0.01, 0.01, 0.03]
        kind = str(self.random.choice(kinds, p=shares))
        self.done[kind] += 1
        getattr(self, f'_{kind}')()
        self._pass_time(PERIOD)

    def stand(self) -> None:
        """Bring the walk to its end: the robot stands, as whoever deactivates it expects."""
        while self.state != 'active':
            wanted = {'unconfigured': Transition.TRANSITION_CONFIGURE}.get(
                self.state, Transition.TRANSITION_ACTIVATE
            )
            self.request(wanted)
        self._joints(np.zeros(18))
        for _ in range(20):
            self._command(np.zeros(30), 0)
            self._pass_time(PERIOD)
        self.request(Transition.TRANSITION_DEACTIVATE)
        farthest = float((robot.JOINT_UPPER - robot.JOINT_LOWER).max())
        for _ in range(int(farthest / STOP_STEP / robot.SUBSTEPS) + 10):
            self._pass_time(PERIOD)
        assert self.motion is Motion.STANDING
        np.testing.assert_array_equal(self.last, robot.NEUTRAL_POSE)

    def request(self, transition: int) -> None:
        """Ask for a transition and hold answer and state against the model."""
        wanted = NEXT.get((self.state, transition))
        if transition == Transition.TRANSITION_CLEANUP and self.motion not in AT_REST:
            wanted = None
        request = ChangeState.Request(transition=Transition(id=transition))
        answer = self.graph.result(self._change.call_async(request))
        assert answer.success == (wanted is not None), (self.state, transition, self.motion)
        self.done['refused' if wanted is None else wanted] += 1
        self.state = wanted or self.state
        reported = self.graph.result(self._state.call_async(GetState.Request()))
        assert reported.current_state.label == self.state

    def _request(self) -> None:
        fitting = [transition for state, transition in NEXT if state == self.state]
        known = self.random.random() < 0.5
        transition = int(self.random.choice(fitting if known else REQUESTS))
        if NEXT.get((self.state, transition)) != 'finalized':
            self.request(transition)

    def _command(self, action: np.ndarray | None = None, late_ns: int | None = None) -> None:
        if action is None:
            action = self.random.uniform(-1.0, 1.0, 30)
        message = CpgCommand()
        command_to_message(command_from_action(action, 'D1', RANGES), message)
        if late_ns is None:
            late_ns = int(self.random.choice([0, 0, 0, 0, -PERIOD, PERIOD, SECOND, -SECOND]))
            if self.random.random() < 0.2:
                field = getattr(message, str(self.random.choice(COMMAND_FIELDS)))
                field[self.random.integers(6)] = self.random.choice(
                    [np.nan, np.inf, -1e300, 1e300, 1e6, -30.0]
                )
        message.header.stamp = time_message(max(self.now_ns - late_ns, 0))
        had = self._received()
        self._commander.publish(message)
        self.graph.until(lambda: self._received() > had)

    def _joints(self, pose: np.ndarray | None = None) -> None:
        """Send joint angles, which count only while the node waits for them."""
        start = getattr(self.cpg._mode, '_start', None)
        if start is None:
            return
        bad = pose is None and self.random.random() < 0.5
        if pose is None:
            pose = self.random.uniform(robot.JOINT_LOWER, robot.JOINT_UPPER)
        names = list(robot.JOINTS[:-1] if bad else robot.JOINTS)
        sample = JointState(name=names, position=pose[: len(names)].tolist())
        sample.header.stamp = time_message(self.now_ns)
        gate = start._samples.gates['joint_states']
        self.graph.until(lambda: self._driver.get_subscription_count() == 1)
        had = gate.counts.received
        self._driver.publish(sample)
        self.graph.until(lambda: gate.counts.received > had)
        if not bad:
            self.last = pose  # the motion begins there at the next tick

    def _stall(self) -> None:
        self._pass_time(int(self.random.integers(PERIOD + 1, SECOND)))

    def _back(self) -> None:
        self._pass_time(-int(self.random.integers(1, 500 * SECOND)))

    def _ahead(self) -> None:
        self._pass_time(int(self.random.integers(SECOND, 500 * SECOND)))

    def _nothing(self) -> None:
        pass

    def _received(self) -> int:
        return self.cpg._mode._samples.gates['cpg/command'].counts.received

    def _pass_time(self, by_ns: int) -> None:
        """Move the clock; a configured node ticks within six periods of time."""
        self.now_ns = max(self.now_ns + by_ns, SECOND)
        ticker = self.cpg._mode._ticker
        self._set_time(self.now_ns)
        if ticker is None:
            return
        had = ticker.meter.ticks
        for _ in range(6):
            deadline = time.monotonic() + WAIT_S
            while time.monotonic() < deadline:
                self.graph.executor.spin_once(timeout_sec=0.002)
                if ticker.meter.ticks != had:
                    return
            self.now_ns += PERIOD
            self._set_time(self.now_ns)
        raise AssertionError('no tick within six periods')

    def _set_time(self, now_ns: int) -> None:
        self._clock.publish(Clock(clock=time_message(now_ns)))
        self.graph.until(lambda: self.cpg.get_clock().now().nanoseconds == now_ns)

    def _check(self, message: JointTrajectory) -> None:
        """Hold a trajectory that leaves the node against what it may be."""
        age_ns = self.now_ns - to_nanoseconds(message.header.stamp)
        assert 0 <= age_ns < PERIOD
        targets = np.array([list(point.positions) for point in message.points])
        assert targets.shape == (robot.SUBSTEPS, 18)
        assert np.isfinite(targets).all()
        assert (targets >= robot.JOINT_LOWER).all()
        assert (targets <= robot.JOINT_UPPER).all()
        steps = np.abs(np.diff(targets, axis=0, prepend=self.last[None]))
        walks = self.motion is Motion.WALKING
        assert steps.max() <= (MAX_STEP if walks else STOP_STEP) * ROUNDING
        assert not walks or self.state == 'active'
        self.last = targets[-1]
        self.done[str(self.motion)] += 1
        self._publish(message)


@pytest.mark.parametrize('start_from', ['measured', 'standing'])
@pytest.mark.parametrize('steps', [600, pytest.param(10_000, marks=pytest.mark.slow)])
def test_whatever_happens_the_targets_are_safe_and_the_robot_stands_in_the_end(
    graph, start_from: str, steps: int
) -> None:
    walk = Walk(graph, 7, start_from)
    walk.cpg.get_logger().set_level(50)
    for _ in range(steps):
        walk.step()
    walk.stand()
    happened = {'refused', 'active', 'inactive', 'unconfigured', 'walking', 'stopping', 'stall'}
    assert happened <= set(walk.done)
    assert walk.done['walking'] > steps / 20


def test_shut_down_amid_a_stride_the_robot_still_comes_to_stand(graph) -> None:
    walk = Walk(graph, 3, 'standing')
    walk.request(Transition.TRANSITION_CONFIGURE)
    walk.request(Transition.TRANSITION_ACTIVATE)
    for _ in range(20):
        walk._command(np.ones(30), 0)
        walk._pass_time(PERIOD)
    assert walk.motion is Motion.WALKING
    walk.request(Transition.TRANSITION_ACTIVE_SHUTDOWN)
    while walk.cpg._mode._ticker is not None:
        walk._pass_time(PERIOD)
    np.testing.assert_array_equal(walk.last, robot.NEUTRAL_POSE)
    assert walk.done['stopping'] > 1
    walk.request(Transition.TRANSITION_ACTIVATE)  # finalized: refused, and no death


def test_of_two_commanders_the_first_one_is_followed_and_the_other_one_told(graph) -> None:
    walk = Walk(graph, 3, 'standing')
    walk.request(Transition.TRANSITION_CONFIGURE)
    walk.request(Transition.TRANSITION_ACTIVATE)
    for _ in range(5):
        walk._command(np.full(30, 0.5), 0)
        walk._pass_time(PERIOD)
    first = walk._commander
    walk._commander = graph.nodes[0].create_publisher(CpgCommand, 'cpg/command', 10)
    graph.until(lambda: walk._commander.get_subscription_count() == 1)
    second = walk._commander
    for _ in range(5):
        for walk._commander, action in ((second, -1.0), (first, 0.5)):
            walk._command(np.full(30, action), 0)
        played = walk.cpg._mode._samples.take()['cpg/command']
        np.testing.assert_array_equal(
            played.hip_gain, command_from_action(np.full(30, 0.5), 'D1', RANGES).hip_gain
        )
        walk._pass_time(PERIOD)
    level, text, values = walk.cpg._health()
    assert level == DiagnosticStatus.WARN
    assert 'cpg/command: has more than one publisher' in text
    assert values['cpg/command.other_publisher'] == 5
    # Once the first one is silent for longer than max_age, the other one drives.
    walk._pass_time(SECOND)
    walk._commander = second
    walk._command(np.full(30, -1.0), 0)
    assert walk.cpg._mode._samples.take() is not None
