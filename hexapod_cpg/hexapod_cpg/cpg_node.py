# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Node `cpg`: the pattern generator as a managed node, with the last word on every joint."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

import numpy as np
from diagnostic_msgs.msg import DiagnosticStatus
from hexapod_interfaces.msg import CpgCommand, CpgState
from hexapod_interfaces.srv import ResetEpisode
from hexapod_node.diagnostics import Diagnostics, Health
from hexapod_node.intra_process import LockStepPublisher, LockStepSubscription
from hexapod_node.invalid_message import fault_kind
from hexapod_node.matching import unheard
from hexapod_node.newest import Input, NewestSamples
from hexapod_node.parameters import ConfigParameters, Parameter, declare
from hexapod_node.qos import COMMAND
from hexapod_node.spin import run
from hexapod_node.stamp_gate import DuePeriod
from hexapod_node.stamps import time_message, to_nanoseconds
from hexapod_node.sync import REALTIME, SYNC, max_age, phase
from hexapod_node.ticker import Tick, Ticker
from hexapod_sim.robot import CONTROL_PERIOD_NS, NO_LOAD_SPEED
from numpy.typing import NDArray
from rclpy.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn
from rclpy.parameter import Parameter as RclpyParameter
from rclpy.publisher import Publisher
from trajectory_msgs.msg import JointTrajectory

from hexapod_cpg.joint_guard import JointGuard
from hexapod_cpg.locomotion import Locomotion, Motion
from hexapod_cpg.mapping import Command
from hexapod_cpg.messages import command_from_message, new_trajectory, targets_to_message
from hexapod_cpg.oscillator import HopfConfig
from hexapod_cpg.real_time import MEASURED, START_FROM, MeasuredStart

PARAMETERS = (
    SYNC,
    Parameter('autostart', True, 'configure and activate the node when it starts'),
    max_age(
        'max_age',
        'a command, and of the joints that the robot starts from; it stops when the newest '
        'command is older',
    ),
    phase(0.010),
    Parameter(
        'max_joint_rate',
        NO_LOAD_SPEED,
        'greatest rate of a joint target; enforced in realtime, counted in lockstep',
        unit='rad/s',
        range=(0.1, 100.0),
    ),
    Parameter(
        'stop_rate',
        0.5,
        'rate of every joint on its way to the standing pose',
        unit='rad/s',
        range=(0.01, 10.0),
    ),
    START_FROM,
)


class CpgNode(LifecycleNode):
    """The pattern generator and its mapping to joint angles.

    Active, it plays commands. Inactive, it brings the robot to its standing pose and holds it.
    Lock-step takes one control period per command; real time one per tick of the clock, from the
    measured joints on: it rises to the standing pose before it plays anything.
    """

    def __init__(self, parameter_overrides: Sequence[RclpyParameter] = ()) -> None:
        """Declare, connect, and start by itself unless told otherwise.

        Args:
            parameter_overrides: values that stand in for the command line's.
        """
        super().__init__('cpg', parameter_overrides=list(parameter_overrides))
        declare(self, PARAMETERS)
        self._config = ConfigParameters(self, HopfConfig, 'cpg')
        value = {entry.name: self.get_parameter(entry.name).value for entry in PARAMETERS}
        self._locomotion = Locomotion(
            self._config.get(), JointGuard(value['max_joint_rate']), value['stop_rate']
        )
        self._active = self._has_walked = False
        self._rejected: Counter[str] = Counter()
        self._trajectory = new_trajectory()
        self._state = CpgState()
        self._real_time = value['sync'] == REALTIME
        self._trajectory_publisher = self._publisher(JointTrajectory, 'joint_trajectory')
        self._state_publisher = self._publisher(CpgState, 'cpg/state')
        self._due = DuePeriod(CONTROL_PERIOD_NS)
        self._samples = NewestSamples(self, {})
        self._ticker: Ticker | None = None
        self._start: MeasuredStart | None = None
        self._max_age_ns = round(value['max_age'] * 1e9)
        if self._real_time:
            wanted = Input(CpgCommand, self._max_age_ns, command_from_message)
            self._samples = NewestSamples(self, {'cpg/command': wanted})
        else:
            LockStepSubscription(self, CpgCommand, 'cpg/command', self._on_command)
            self.create_service(ResetEpisode, '~/reset', self._on_reset)
        Diagnostics(self, self._health)
        if value['autostart']:
            self.trigger_configure()
            self.trigger_activate()

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Begin to hold the standing pose, or to find out how far away it is."""
        if self._real_time and self.get_parameter('start_from').value == MEASURED:
            self._locomotion.wait(self._config.get())
            self._start = MeasuredStart(self, self._max_age_ns)
        else:
            self._locomotion.stand(self._config.get())
        if self._real_time:
            phase_ns = round(self.get_parameter('phase').value * 1e9)
            self._ticker = Ticker(self, CONTROL_PERIOD_NS, self._on_tick, phase_ns)
        return super().on_configure(state)

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Play commands from now on."""
        self._active, self._has_walked = True, False
        return super().on_activate(state)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Play no more commands: bring the robot to its standing pose."""
        self._active = False
        return super().on_deactivate(state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Leave the robot to itself, once it stands."""
        if self._locomotion.motion in (Motion.RISING, Motion.STOPPING):
            self.get_logger().error('cleanup refused: the robot is on its way to stand')
            return TransitionCallbackReturn.FAILURE
        self._release()
        return super().on_cleanup(state)

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Leave the robot to itself."""
        self._release()
        return super().on_shutdown(state)

    def _release(self) -> None:
        self._active = False
        self._due.stop()
        self._drop_start()
        if self._ticker is not None:
            self._ticker.destroy()
            self._ticker = None

    def _on_reset(
        self, request: ResetEpisode.Request, response: ResetEpisode.Response
    ) -> ResetEpisode.Response:
        """Put the oscillators at the start of the gait and publish their state."""
        response.start = request.start
        listeners = dict(zip(request.topics, request.subscriptions, strict=True))
        response.message = unheard([self._trajectory_publisher, self._state_publisher], listeners)
        if not self._active:
            response.message = 'cpg is not active: expected `ros2 lifecycle set cpg activate`'
        response.success = not response.message
        if response.success:
            self._locomotion.stand(self._config.get())
            self._due.start(to_nanoseconds(request.start))
            self._publish_state(to_nanoseconds(request.start))
        return response

    def _on_command(self, message: CpgCommand) -> None:
        """Advance one period, if the command is the one of the period that is due."""
        stamp_ns = to_nanoseconds(message.header.stamp)
        if not self._due.admit(stamp_ns):
            return
        try:
            targets = self._play(message)
        except ValueError as error:
            self._rejected[fault_kind(error)] += 1
            self.get_logger().error(f'{error}; the period is not played')
            return
        self._due.start(stamp_ns + CONTROL_PERIOD_NS)
        self._publish_trajectory(targets, stamp_ns)
        self._publish_state(stamp_ns + CONTROL_PERIOD_NS)

    def _publisher(self, kind: type, topic: str) -> Publisher | LockStepPublisher:
        if self._real_time:
            return self.create_publisher(kind, topic, COMMAND)
        return LockStepPublisher(self, kind, topic)

    def _play(self, message: CpgCommand) -> NDArray[np.float64]:
        if not self._active:
            return self._locomotion.stop()
        return self._locomotion.play(command_from_message(message))

    def _on_tick(self, tick: Tick) -> None:
        """Advance one period with the newest command, or stop where there is none."""
        if self._knows_the_joints():
            newest = self._samples.take() if self._active else None
            targets = self._walk(newest['cpg/command']) if newest else self._locomotion.stop()
            self._publish_trajectory(targets, tick.stamp_ns)
        self._publish_state(tick.stamp_ns + CONTROL_PERIOD_NS)

    def _knows_the_joints(self) -> bool:
        """Return whether the robot may move; the first sample of its joints makes it rise."""
        if self._start is None:
            return True
        pose = self._start.take()
        if pose is None:
            return False
        self._locomotion.rise(pose)
        self._drop_start()
        return True

    def _drop_start(self) -> None:
        if self._start is not None:
            self._start.destroy()
            self._start = None

    def _walk(self, command: Command) -> NDArray[np.float64]:
        if self._locomotion.motion is Motion.STANDING:
            self._locomotion.restart(self._config.get())
        try:
            targets = self._locomotion.walk(command)
        except ValueError as error:
            self._rejected[fault_kind(error)] += 1
            self.get_logger().error(f'{error}; the robot stops', throttle_duration_sec=1.0)
            return self._locomotion.stop()
        walks = self._locomotion.motion is Motion.WALKING
        if walks and not self._has_walked and self._ticker is not None:
            self._ticker.meter.restart()  # what counts is how the robot walks
            self._has_walked = True
        return targets

    def _publish_trajectory(self, targets: NDArray[np.float64], stamp_ns: int) -> None:
        targets_to_message(targets, self._trajectory)
        self._trajectory.header.stamp = time_message(stamp_ns)
        self._trajectory_publisher.publish(self._trajectory)

    def _publish_state(self, stamp_ns: int) -> None:
        self._state.header.stamp = time_message(stamp_ns)
        self._state.x = self._locomotion.cpg.x
        self._state.y = self._locomotion.cpg.y
        self._state_publisher.publish(self._state)

    def _health(self) -> Health:
        guard = self._locomotion.guard
        values: dict[str, object] = {
            'active': self._active,
            'motion': str(self._locomotion.motion),
            'rejected': self._rejected.total(),
            'beyond_limit': guard.beyond_limit,
            'beyond_rate': guard.beyond_rate,
            **self._rejected,
        }
        if self._real_time:
            values |= self._samples.values()
            values |= self._start.values() if self._start is not None else {}
            values |= self._ticker.meter.values() if self._ticker is not None else {}
            fault = self._samples.fault() if self._active else 'not active'
            fault = self._start.fault() if self._start is not None else fault
            level = DiagnosticStatus.WARN if fault else DiagnosticStatus.OK
            return level, fault or str(self._locomotion.motion), values
        counts = vars(self._due.counts)
        if self._rejected.total() or any(counts.values()):
            return DiagnosticStatus.WARN, 'commands came that were not due', values | counts
        return DiagnosticStatus.OK, 'in step', values | counts


def main(args: Sequence[str] | None = None) -> None:
    """Run the node until a signal comes."""
    run(CpgNode, args)
