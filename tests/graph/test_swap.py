# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A walking robot whose sensors are swapped for drivers of their own, and broken one by one."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import pytest
from hexapod_agent.contract.limits import Limits, parse_frames
from hexapod_agent.contract.report import SensorReport
from hexapod_agent.learning import checkpoint
from hexapod_agent.learning.training import Trainer
from hexapod_agent.nodes import real_time
from hexapod_agent.nodes.contract_check import listen_and_check
from hexapod_agent.nodes.play_node import PlayNode
from hexapod_agent.nodes.real_time import State
from hexapod_agent.specification.observation import ObservationSpec
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_cpg.locomotion import Motion
from hexapod_cpg.nodes.cpg_node import CpgNode
from hexapod_node.coroutines import start
from hexapod_sim.fake_device import DEVICES as ROWS
from hexapod_sim.fake_device import fault_names
from hexapod_sim.nodes.fake_driver_node import FakeDriverNode
from hexapod_sim.nodes.sim_node import SimNode
from hexapod_sim.sensor_table import LETTERS
from nav_msgs.msg import Odometry
from rclpy.parameter import Parameter
from trajectory_msgs.msg import JointTrajectory

from hexapod_sim import robot

pytestmark = pytest.mark.graph
SMALL = {'actor': {'hidden': [16, 12]}, 'critic': {'hidden': [16, 12]}}
AGE_S = 0.4
LISTEN_S = 0.4
AGES = [f'{p.name}:={AGE_S}' for p in real_time.PARAMETERS if p.name.startswith('max_age')]


@dataclass(frozen=True)
class Device:
    """A driver as a lab might have it: its own topic, frame, order and errors."""

    topic: str
    settings: dict[str, object]
    frame: str = ''


DEVICES = {
    'joint_states': Device(
        'servos/state',
        {'joint_order': 'shuffled', 'joint_prefix': 'px/', 'extra_joints': 2, 'noise': 0.002,
         'quantisation': 0.005},
    ),
    'line_offset': Device('camera/line', {'noise': 0.005, 'delay': 0.05}, 'camera'),
    'joint_torques': Device(
        'servos/load', {'joint_order': 'reversed', 'quantisation': 0.02, 'noise': 0.02}
    ),
    'body/twist': Device('flow/twist', {'noise': 0.02, 'bias': 0.01}, 'flow'),
    'imu/data': Device('bno055/data', {'noise': 0.01, 'bias': 0.01}, 'bno055'),
    'imu/data_raw': Device('bno055/raw', {'noise': 0.02, 'bias': 0.01}, 'bno055'),
    'body/height': Device('tof/range', {'noise': 2e-3, 'quantisation': 1e-3, 'rate': 20.0}, 'tof'),
    'foot_force': Device('cells/force', {'noise': 0.2, 'dropout': 0.02}, 'cell'),
    'foot_contacts': Device('switches', {'dropout': 0.02}),
}  # fmt: skip


def remaps(channels: list[str]) -> dict[str, str]:
    """Return the devices' topics by those of the sensor table."""
    return {
        topic: DEVICES[channel].topic + topic.removeprefix(channel)
        for channel in channels
        for topic in ROWS[channel].topics
    }


def frames(channels: list[str]) -> str:
    """Return what the user says of the devices' frames."""
    return ' '.join(
        f'{topic}={DEVICES[channel].frame}{topic.removeprefix(channel).replace("/", "_")}'
        for channel in channels
        if DEVICES[channel].frame
        for topic in ROWS[channel].topics
    )


class Robot:
    """Sim, pattern generator, agent and drivers in real time, and what they say."""

    def __init__(self, graph, swapped: list[str], pace: float) -> None:
        self.graph = graph
        self.pace = pace
        self.limits = Limits(
            AGE_S, silence=2.0 * LISTEN_S / self.pace, frames=parse_frames(frames(swapped))
        )
        self.x = 0.0
        self.targets: list[float] = []
        self.drivers = {channel: self._driver(channel) for channel in swapped}
        node = graph.nodes[0]
        node.create_subscription(Odometry, 'odom', self._on_odometry, 10)
        node.create_subscription(JointTrajectory, 'joint_trajectory', self._on_targets, 10)
        graph.add(*self.drivers.values(), SimNode())
        self.play, self.cpg = graph.add(PlayNode()), graph.add(CpgNode())

    def walks_on(self) -> None:
        """Wait until the robot has come a step further."""
        self.until_it_is(State.DRIVING)
        here = self.x
        self.until(lambda: self.x > here + 0.02)

    def stops(self) -> None:
        """Wait until the robot stands in its standing pose."""
        self.until_it_is(State.HOLDING)
        self.until(lambda: self.cpg._locomotion.motion is Motion.STANDING)
        self.until(lambda: self.targets == robot.NEUTRAL_POSE.tolist())

    def until_it_is(self, state: State) -> None:
        """Wait for what the agent does."""
        self.until(lambda: self.play._play.state is state)

    def until(self, predicate: Callable[[], bool]) -> None:
        """Wait up to ten seconds of the sim's time."""
        self.graph.until(predicate, 10.0 / self.pace)

    def set_fault(self, channel: str, fault: str) -> None:
        """Break a driver, or mend it."""
        done = self.drivers[channel].set_parameters([Parameter('fault', value=fault)])
        assert done[0].successful, done[0].reason

    def check(self, reliable: bool = False) -> SensorReport:
        """Check the sensors as the agent hears them."""
        seconds = LISTEN_S / self.pace
        checked = listen_and_check(
            self.graph.nodes[0], ObservationSpec(LETTERS), seconds, self.limits, reliable, seconds
        )
        return self.graph.result(start(checked))

    def _driver(self, channel: str) -> FakeDriverNode:
        device = DEVICES[channel]
        settings = {
            'channel': channel,
            'topic': device.topic,
            'frame': device.frame,
            **device.settings,
        }
        parameters = [Parameter(name, value=value) for name, value in settings.items()]
        return FakeDriverNode(f'driver_{channel.replace("/", "_")}', parameters)

    def _on_odometry(self, message: Odometry) -> None:
        self.x = message.pose.pose.position.x

    def _on_targets(self, message: JointTrajectory) -> None:
        self.targets = list(message.points[-1].positions)


@pytest.fixture
def swapped(request) -> list[str]:
    """Return the channels that come from drivers; all unless the test says how many."""
    return list(DEVICES)[: getattr(request, 'param', None)]


@pytest.fixture
def pace() -> float:
    """Return simulated seconds per second that this process keeps on a busy machine."""
    wall, cpu = time.monotonic(), time.process_time()
    while time.process_time() - cpu < 0.1:
        pass
    share = 0.1 / (time.monotonic() - wall)
    return min(max(share, 0.15), 0.5)


@pytest.fixture
def ros_args(tmp_path, swapped, pace: float) -> list[str]:
    """Return arguments for real time, an untrained agent of all channels, and the swaps."""
    trainer = Trainer(RunSpec.from_mapping(SMALL, 'small').observing(LETTERS), 5)
    checkpoint.save_agent(tmp_path / 'agent.pt', trainer)
    given = {
        'checkpoint': f'{tmp_path}/agent.pt',
        'check_seconds': str(LISTEN_S / pace),
        'max_age': '0.6',
        'stop_rate': '3.0',
        'real_time_factor': str(pace),
        'play:use_sim_time': 'true',
        'cpg:use_sim_time': 'true',
    }
    given |= {'frames': frames(swapped)} if frames(swapped) else {}
    words = ['sync:=realtime', *AGES, *(f'{name}:={value}' for name, value in given.items())]
    return [
        '--ros-args',
        *(word for text in words for word in ('-p', text)),
        *(
            word
            for ours, own in remaps(swapped).items()
            for node in ('cpg', 'play', 'test')
            for word in ('-r', f'{node}:{ours}:={own}')
        ),
    ]


@pytest.fixture
def walking(graph, swapped, pace: float) -> Robot:
    """Return a robot on its way."""
    made = Robot(graph, swapped, pace)
    made.walks_on()
    return made


# What each fault of a driver is to the check: kind and field, by fault and by channel where
# that decides.
KINDS = {
    'stopped': ('stopped', 'topic'),
    'stale_stamps': ('stale_stamps', 'header.stamp'),
    'nan': ('not_finite', None),
    'wrong_length': ('wrong_length', None),
    'wrong_names': ('wrong_names', 'name'),
    'wrong_frame': ('wrong_frame', 'header.frame_id'),
    'bad_quaternion': ('bad_quaternion', 'orientation'),
    'flipped_gravity': ('flipped_gravity', 'linear_acceleration.z'),
    'wrong_unit': ('wrong_unit', None),
}
FIELDS = {
    'joint_states': 'position',
    'line_offset': 'offset',
    'joint_torques': 'effort',
    'body/twist': 'twist.linear',
    'imu/data': 'orientation',
    'imu/data_raw': 'angular_velocity',
    'body/height': 'range',
    'foot_force': 'wrench.force',
}


def assert_named_and_stopped(walking: Robot, channel: str, fault: str) -> None:
    """Break a driver: the check names fault and field, the robot stops, and mended walks on."""
    kind, field = KINDS[fault]
    field = field or FIELDS[channel]
    if (channel, fault) == ('imu/data', 'wrong_unit'):
        field = 'linear_acceleration'
    walking.set_fault(channel, fault)
    report = walking.check()
    named = [found for found in report.faults if found.kind == kind]
    assert named, report.refusal
    topics = {f'/{own}' for own in remaps([channel]).values()}
    assert {found.topic for found in report.faults} <= topics, report.refusal
    assert any(found.field.startswith(field) for found in named), report.refusal
    assert all(found.cure for found in named)
    walking.stops()
    walking.set_fault(channel, '')
    walking.walks_on()


def test_the_robot_walks_with_drivers_of_every_channel_and_stops_when_one_breaks(walking) -> None:
    heard = {subscription.topic_name for subscription in walking.play.subscriptions}
    swaps = remaps(list(DEVICES))
    assert {f'/{own}' for own in swaps.values()} <= heard
    report = walking.check()
    assert report.passed, report.refusal
    lock_step = walking.check(reliable=True).faults
    assert {fault.kind for fault in lock_step} == {'qos_mismatch'}
    assert {fault.topic for fault in lock_step} == {f'/{own}' for own in swaps.values()}
    for channel, fault in (
        ('foot_contacts', 'stopped'),
        ('joint_states', 'wrong_length'),
        ('body/height', 'nan'),
        ('body/twist', 'wrong_frame'),
        ('line_offset', 'stale_stamps'),
        ('joint_torques', 'wrong_unit'),
        ('imu/data', 'flipped_gravity'),
    ):
        assert_named_and_stopped(walking, channel, fault)
    assert walking.check().passed


@pytest.mark.slow
@pytest.mark.parametrize('channel', DEVICES)
def test_every_fault_of_every_driver_is_named_and_stops_the_robot(walking, channel: str) -> None:
    for fault in fault_names(ROWS[channel]):
        assert_named_and_stopped(walking, channel, fault)
    assert walking.check().passed


@pytest.mark.slow
@pytest.mark.parametrize('swapped', range(len(DEVICES) + 1), indirect=True)
def test_one_channel_after_another_comes_from_a_driver(walking, swapped: list[str]) -> None:
    report = walking.check()
    assert report.passed, report.refusal
    topics = {row.topic for row in report.rows}
    assert {f'/{own}' for own in remaps(swapped).values()} <= topics
    walking.walks_on()
