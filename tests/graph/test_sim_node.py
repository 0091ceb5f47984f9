# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Node sim: units, frames, what is published to whom, resets, and input that is wrong."""

from __future__ import annotations

import math

import numpy as np
import pytest
from builtin_interfaces.msg import Time
from geometry_msgs.msg import TwistStamped, WrenchStamped
from hexapod_cpg.nodes.messages import OutputMessages
from hexapod_interfaces.msg import FootContacts, LineOffset, StepOutcome
from hexapod_interfaces.srv import ResetEpisode
from hexapod_node.stamps import time_message, to_nanoseconds
from hexapod_sim.nodes.sim_node import SimNode
from hexapod_sim.sums import ordered_sum
from hexapod_sim.task import LineTask, episode_seed
from hexapod_sim.task_config import TaskConfig
from nav_msgs.msg import Odometry
from rcl_interfaces.srv import SetParametersAtomically
from rclpy.parameter import Parameter
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Imu, JointState, Range
from trajectory_msgs.msg import JointTrajectory

from hexapod_sim import robot, sensors

pytestmark = pytest.mark.graph
SEED = episode_seed(3, 0)
STANDING = np.tile(robot.NEUTRAL_POSE, (robot.SUBSTEPS, 1))


class Rig:
    """A sim node, and a listener that keeps the messages of each topic."""

    def __init__(self, graph) -> None:
        self.graph = graph
        self.sim = graph.add(SimNode())
        self.node = graph.nodes[0]
        self.heard: dict[str, list] = {}
        self.publisher = self.node.create_publisher(JointTrajectory, 'joint_trajectory', 10)
        graph.until(lambda: self.publisher.get_subscription_count() == 1)

    def listen(self, topic: str, kind: type) -> list:
        self.heard[topic] = []
        self.node.create_subscription(kind, topic, self.heard[topic].append, 10)
        return self.heard[topic]

    def reset(self, seed: int = SEED, start_ns: int = 0) -> ResetEpisode.Response:
        request = ResetEpisode.Request(seed=seed, start=time_message(start_ns))
        request.topics = [f'/{topic}' for topic in self.heard]
        request.subscriptions = [1] * len(self.heard)
        while not (response := self.graph.call(ResetEpisode, 'sim/reset', request)).success:
            self.graph.executor.spin_once(timeout_sec=0.01)
        self.wait(1)
        return response

    def wait(self, count: int) -> None:
        self.graph.until(lambda: all(len(had) >= count for had in self.heard.values()))

    def play(self, stamp_ns: int, targets: np.ndarray = STANDING) -> None:
        self.publisher.publish(OutputMessages().trajectory(targets, stamp_ns))


@pytest.fixture
def rig(graph) -> Rig:
    return Rig(graph)


def test_messages_carry_units_frames_and_the_stamp(rig: Rig) -> None:
    joints = rig.listen('joint_states', JointState)
    torques = rig.listen('joint_torques', JointState)
    twist = rig.listen('body/twist', TwistStamped)
    imu = rig.listen('imu/data', Imu)
    raw = rig.listen('imu/data_raw', Imu)
    height = rig.listen('body/height', Range)
    contacts = rig.listen('foot_contacts', FootContacts)
    feet = [rig.listen(f'foot_force/{leg}', WrenchStamped) for leg in robot.LEGS]
    odometry = rig.listen('odom', Odometry)
    start = rig.reset()
    for had in rig.heard.values():
        assert had[0].header.stamp == start.start
    assert tuple(joints[0].name) == tuple(torques[0].name) == robot.JOINTS
    np.testing.assert_allclose(joints[0].position, robot.NEUTRAL_POSE, atol=0.1)
    assert len(torques[0].effort) == 18
    assert not torques[0].position
    assert (twist[0].header.frame_id, imu[0].header.frame_id) == ('base_link', 'imu_link')
    # REP-145: an accelerometer at rest reads +g upwards; -1 says that a field is not given.
    assert imu[0].linear_acceleration.z == pytest.approx(9.81, abs=0.05)
    q = imu[0].orientation
    assert math.hypot(q.x, q.y, q.z, q.w) == pytest.approx(1.0)
    assert q.w == pytest.approx(1.0, abs=0.01)
    assert raw[0].orientation_covariance[0] == -1.0
    assert height[0].min_range < height[0].range < height[0].max_range
    assert all(contacts[0].contact)
    # The floor carries the robot: 2.4 kg at 9.81 m/s^2.
    weight = sum(foot[0].wrench.force.z for foot in feet)
    assert weight == pytest.approx(robot.TOTAL_MASS * 9.81, rel=0.02)
    assert [foot[0].header.frame_id for foot in feet] == [f'{leg}_foot' for leg in robot.LEGS]
    assert (odometry[0].header.frame_id, odometry[0].child_frame_id) == ('odom', 'base_link')


def test_the_offset_is_that_of_the_seed_and_of_the_pose(rig: Rig) -> None:
    offset = rig.listen('line_offset', LineOffset)
    odometry = rig.listen('odom', Odometry)
    rig.reset()
    task = LineTask(TaskConfig.of_article())
    task.reset(SEED)
    assert offset[0].offset == task.line_offset
    assert odometry[0].pose.pose.position.y == pytest.approx(offset[0].offset)


def test_time_goes_on_over_resets_and_the_state_starts_afresh(rig: Rig) -> None:
    joints = rig.listen('joint_states', JointState)
    outcome = rig.listen('step_outcome', StepOutcome)
    clock = rig.listen('clock', Clock)
    first = to_nanoseconds(rig.reset().start)
    rig.play(first, STANDING + 0.2)
    rig.wait(2)
    second = to_nanoseconds(rig.reset().start)
    rig.wait(3)
    period = robot.CONTROL_PERIOD_NS
    stamps = [to_nanoseconds(message.clock) for message in clock]
    assert stamps == [first, first + period, first + 2 * period]
    assert second == stamps[2]
    assert joints[0].position == joints[2].position
    assert joints[0].position != joints[1].position
    assert [message.step for message in outcome] == [0, 1, 0]
    assert outcome[1].reward == ordered_sum(outcome[1].term_values)


def test_nothing_is_read_for_topics_that_nobody_hears(rig: Rig, monkeypatch) -> None:
    read = []
    monkeypatch.setattr(
        sensors, 'read', lambda simulation, keys: read.extend(keys) or {'height': np.ones(1)}
    )
    rig.listen('body/height', Range)
    rig.reset()
    assert read == ['height']


def test_a_reset_waits_for_its_listeners(rig: Rig) -> None:
    request = ResetEpisode.Request(topics=['/imu/data'], subscriptions=[2])
    response = rig.graph.call(ResetEpisode, 'sim/reset', request)
    assert not response.success
    assert response.message == '/imu/data has 0 of 2 subscriptions'


@pytest.mark.parametrize(
    ('spoil', 'complaint'),
    [
        (lambda m: m.joint_names.pop(), 'joint_names are'),
        (lambda m: m.points.pop(), '4 points, expected 5'),
        (lambda m: m.points[2].positions.pop(), 'point 2 has 17 positions, expected 18'),
        (lambda m: m.points[1].positions.__setitem__(3, math.nan), 'NaN'),
    ],
)
def test_a_wrong_trajectory_is_refused_by_name(rig: Rig, spoil, complaint: str) -> None:
    outcome = rig.listen('step_outcome', StepOutcome)
    errors = []
    rig.sim.get_logger().error = errors.append
    start = to_nanoseconds(rig.reset().start)
    message = OutputMessages().trajectory(STANDING, start)
    spoil(message)
    rig.publisher.publish(message)
    rig.graph.until(lambda: bool(errors))
    assert complaint in errors[0]
    rig.play(start)  # the period is still due
    rig.wait(2)
    assert outcome[1].step == 1


def test_trajectories_that_are_not_due_change_nothing(rig: Rig) -> None:
    outcome = rig.listen('step_outcome', StepOutcome)
    start = to_nanoseconds(rig.reset().start)
    period = robot.CONTROL_PERIOD_NS
    for stamp in (start + period, start, start, start + period):
        rig.play(stamp)
    rig.wait(3)
    assert [message.step for message in outcome] == [0, 1, 2]
    counts = rig.sim._due.counts
    assert (counts.out_of_order, counts.duplicate, counts.late) == (1, 1, 0)


def test_the_task_is_configured_by_parameters(rig: Rig) -> None:
    outcome = rig.listen('step_outcome', StepOutcome)
    limit = Parameter('task.time_limit_steps', value=1).to_parameter_msg()
    request = SetParametersAtomically.Request(parameters=[limit])
    answer = rig.graph.call(SetParametersAtomically, 'sim/set_parameters_atomically', request)
    assert answer.result.successful
    rig.play(to_nanoseconds(rig.reset().start))
    rig.wait(2)
    assert (outcome[1].truncated, outcome[1].cause) == (True, 'time_limit')


@pytest.mark.parametrize(
    ('text', 'complaint'),
    [
        ('{imu: {noise: 0.1}}', "unknown channel 'imu', expected one of joint_states"),
        ('{imu_data: {noise: -1}}', 'sensors.imu_data.noise is -1'),
        ('{imu_data: {hiss: 1}}', 'sensors.imu_data.hiss is 1: '),
        ('{imu_data: 1}', 'expected {channel: {key: value}}'),
        ('noise', 'expected {channel: {key: value}}'),
        ('[', 'expected {channel: {key: value}}'),
    ],
)
def test_qualities_that_do_not_fit_are_refused(rig: Rig, text: str, complaint: str) -> None:
    given = Parameter('sensors.qualities', value=text).to_parameter_msg()
    request = SetParametersAtomically.Request(parameters=[given])
    answer = rig.graph.call(SetParametersAtomically, 'sim/set_parameters_atomically', request)
    assert not answer.result.successful
    assert complaint in answer.result.reason


@pytest.mark.parametrize(
    ('request_', 'complaint'),
    [
        (
            ResetEpisode.Request(topics=['/odom'], subscriptions=[]),
            'topics and subscriptions: 1 and',
        ),
        (ResetEpisode.Request(start=Time(sec=2**31 - 1)), 'start 2147483647 s: expected 0 to'),
        (ResetEpisode.Request(start=Time(sec=-1)), 'start -1 s: expected 0 to'),
    ],
)
def test_a_reset_that_makes_no_sense_is_refused_and_costs_nothing(
    rig: Rig, request_: ResetEpisode.Request, complaint: str
) -> None:
    response = rig.graph.call(ResetEpisode, 'sim/reset', request_)
    assert not response.success
    assert complaint in response.message
    assert rig.reset().success
    assert to_nanoseconds(rig.reset().start) == 2 * robot.CONTROL_PERIOD_NS
