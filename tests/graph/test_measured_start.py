# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""In real time the first motion begins where the joints are, and not before they have told."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from hexapod_cpg.locomotion import Motion
from hexapod_cpg.mapping import ActionRanges, command_from_action
from hexapod_cpg.nodes.cpg_node import CpgNode
from hexapod_cpg.nodes.messages import command_to_message
from hexapod_interfaces.msg import CpgCommand, CpgState
from hexapod_node.qos import DRIVER
from hexapod_node.stamps import to_nanoseconds
from lifecycle_msgs.msg import Transition
from lifecycle_msgs.srv import ChangeState
from rclpy.lifecycle import TransitionCallbackReturn
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory

from hexapod_sim import robot

RANGES = ActionRanges.of_article()

pytestmark = pytest.mark.graph
RATE = 2.0
STEP = RATE * 0.005  # targets are 5 ms apart
CROUCHED = np.tile([0.3, 1.1, -0.9], 6)
# A driver has its own order, and joints of its own.
ORDER = [*np.random.default_rng(7).permutation(robot.JOINTS).tolist(), 'camera_pan']


@pytest.fixture
def ros_args(request) -> list[str]:
    # A busy machine may hold up a whole process: an age that no pause of it reaches.
    given = ['sync:=realtime', f'stop_rate:={RATE}', 'max_age:=2.0']
    if 'standing' in request.node.name:
        given += ['start_from:=standing']
    return ['--ros-args', *(word for value in given for word in ('-p', value))]


def stamp_ns(message: JointTrajectory | CpgState) -> int:
    return to_nanoseconds(message.header.stamp)


class Rig:
    """A pattern generator with a best-effort driver, a commander, and listeners."""

    def __init__(self, graph) -> None:
        self.graph = graph
        self.trajectories: list[JointTrajectory] = []
        self.states: list[CpgState] = []
        self.diagnostics: list[DiagnosticStatus] = []
        self.pose: np.ndarray | None = None
        self.spoil: Callable[[JointState], object] = lambda message: None
        node = graph.nodes[0]
        node.create_subscription(JointTrajectory, 'joint_trajectory', self.trajectories.append, 50)
        node.create_subscription(CpgState, 'cpg/state', self.states.append, 50)
        node.create_subscription(
            DiagnosticArray, '/diagnostics', lambda m: self.diagnostics.extend(m.status), 10
        )
        self._driver = node.create_publisher(JointState, 'joint_states', DRIVER)
        self._commander = node.create_publisher(CpgCommand, 'cpg/command', 1)
        node.create_timer(0.02, self._publish)
        self.cpg = graph.add(CpgNode())
        graph.until(lambda: self.cpg._mode._trajectory.get_subscription_count() == 1)
        graph.until(lambda: self._commander.get_subscription_count() == 1)

    def _publish(self) -> None:
        stamp = self.graph.nodes[0].get_clock().now().to_msg()
        command = CpgCommand()
        command_to_message(command_from_action(np.zeros(30), 'D1', RANGES), command)
        command.header.stamp = stamp
        self._commander.publish(command)
        if self.pose is None:
            return
        angles = dict(zip(robot.JOINTS, self.pose.tolist(), strict=True))
        sample = JointState(name=ORDER, position=[angles.get(name, 9.0) for name in ORDER])
        sample.header.stamp = stamp
        self.spoil(sample)
        self._driver.publish(sample)

    def until_it_is(self, motion: Motion) -> None:
        """Wait for a motion of the legs."""
        self.graph.until(lambda: self.cpg._locomotion.motion is motion)

    def targets(self) -> np.ndarray:
        """Return the joint targets so far (any number, 18)."""
        return np.array([list(p.positions) for t in self.trajectories for p in t.points])

    def waits(self) -> None:
        """Assert that for some periods nothing is commanded, and that the node says why."""
        self.diagnostics.clear()
        ended = len(self.states) + 8
        self.graph.until(lambda: len(self.states) > ended and bool(self.diagnostics))
        assert self.trajectories == []
        assert self.diagnostics[-1].level == DiagnosticStatus.WARN
        assert 'does not move, waits for joint_states' in self.diagnostics[-1].message

    def forget(self, ended_ns: int) -> None:
        """Wait for states of a later time, and drop the trajectories that were under way."""
        later_ns = ended_ns + 4 * robot.CONTROL_PERIOD_NS
        self.graph.until(lambda: stamp_ns(self.states[-1]) > later_ns)
        self.trajectories[:] = [t for t in self.trajectories if stamp_ns(t) > ended_ns]

    def heard(self) -> set[str]:
        return {subscription.topic_name for subscription in self.cpg.subscriptions}

    def change(self, transition: int) -> None:
        request = ChangeState.Request(transition=Transition(id=transition))
        assert self.graph.call(ChangeState, 'cpg/change_state', request).success


@pytest.fixture
def rig(graph) -> Rig:
    return Rig(graph)


def assert_rises(rig: Rig, pose: np.ndarray) -> None:
    """Assert that the legs come slowly from a pose to stand, commands or not, and walk then."""
    rig.pose = pose
    rig.until_it_is(Motion.WALKING)
    rig.graph.until(lambda: len(rig.trajectories) > 3)
    targets = rig.targets()
    assert np.abs(targets[0] - pose).max() == pytest.approx(STEP)
    stands = int(np.flatnonzero((targets == robot.NEUTRAL_POSE).all(axis=1))[0])
    # The farthest joint is so many steps away; rounding may cost one more.
    needed = np.abs(pose - robot.NEUTRAL_POSE).max() / STEP
    assert stands + 1 == pytest.approx(needed, abs=2)
    steps = np.diff(targets[: stands + 1], axis=0)
    assert np.abs(steps).max() <= STEP * (1 + 1e-9)


def test_the_first_motion_begins_at_the_measured_joints_and_again_after_a_cleanup(rig) -> None:
    rig.waits()
    assert_rises(rig, CROUCHED)
    assert '/joint_states' not in rig.heard()
    assert rig.cpg._health()[:2] == (DiagnosticStatus.OK, 'walking')
    rig.change(Transition.TRANSITION_DEACTIVATE)
    rig.until_it_is(Motion.STOPPING)
    rig.until_it_is(Motion.STANDING)
    rig.pose = None
    rig.change(Transition.TRANSITION_CLEANUP)
    ended_ns = rig.cpg.get_clock().now().nanoseconds
    rig.change(Transition.TRANSITION_CONFIGURE)
    rig.forget(ended_ns)
    rig.waits()
    rig.change(Transition.TRANSITION_ACTIVATE)
    assert_rises(rig, -0.5 * CROUCHED)


def drop_a_joint(sample: JointState) -> None:
    index = sample.name.index('lm_ankle')
    sample.name = [*sample.name[:index], *sample.name[index + 1 :]]
    sample.position.pop(index)


def put_knee(angle: float) -> Callable[[JointState], None]:
    return lambda sample: sample.position.__setitem__(sample.name.index('rf_knee'), angle)


@pytest.mark.parametrize(
    ('spoil', 'complaint'),
    [
        (drop_a_joint, 'name lacks lm_ankle'),
        (put_knee(np.nan), 'rf_knee is at nan rad'),
        (put_knee(14.0), 'rf_knee is at 14 rad, expected -1.2 to 1.2'),
    ],
    ids=['missing', 'nan', 'degrees'],
)
def test_a_bad_sample_is_refused_by_name_and_the_next_good_one_taken(
    rig, spoil, complaint: str
) -> None:
    rig.spoil, rig.pose = spoil, CROUCHED
    rig.graph.until(lambda: complaint in rig.cpg._health()[1])
    rig.waits()
    rig.spoil = lambda message: None
    assert_rises(rig, CROUCHED)


def test_a_robot_without_feedback_is_taken_to_be_standing(rig) -> None:
    assert '/joint_states' not in rig.heard()
    rig.until_it_is(Motion.WALKING)
    rig.graph.until(lambda: len(rig.trajectories) > 3)
    # From there on at the rate of a walk.
    step = robot.NO_LOAD_SPEED * 0.005
    first = rig.targets()[0]
    assert np.abs(first - robot.NEUTRAL_POSE).max() <= step * (1 + 1e-9)


def test_it_is_not_cleaned_up_while_it_rises(rig) -> None:
    rig.change(Transition.TRANSITION_DEACTIVATE)
    rig.pose = CROUCHED
    rig.until_it_is(Motion.RISING)
    assert rig.cpg.trigger_cleanup() is TransitionCallbackReturn.FAILURE
    rig.until_it_is(Motion.STANDING)
