# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The pattern generator in real time: one control period per tick, with the newest command."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from diagnostic_msgs.msg import DiagnosticStatus
from hexapod_interfaces.msg import CpgCommand, CpgState
from hexapod_node.invalid_message import fault_kind
from hexapod_node.newest import Input, NewestSamples
from hexapod_node.qos import COMMAND
from hexapod_node.ticker import Tick, Ticker
from hexapod_sim.robot import CONTROL_PERIOD_NS
from numpy.typing import NDArray
from trajectory_msgs.msg import JointTrajectory

from hexapod_cpg.locomotion import Locomotion, Motion
from hexapod_cpg.mapping import Command
from hexapod_cpg.nodes.measured_start import MEASURED, MeasuredStart
from hexapod_cpg.nodes.messages import OutputMessages, command_from_message
from hexapod_cpg.oscillator import HopfConfig

if TYPE_CHECKING:
    from hexapod_node.diagnostics import Health
    from rclpy.node import Node


class RealTimeCpg:
    """Moves the robot at every tick of the clock while the node is configured.

    Active, it plays the newest command; inactive, or where the command is too old, it goes on
    with the way to the standing pose. The first way leads there from the measured joints.
    """

    def __init__(
        self, node: Node, locomotion: Locomotion, config: Callable[[], HopfConfig]
    ) -> None:
        """Subscribe; ticks begin with `configure`.

        Args:
            node: that has the endpoints and the parameters of `cpg`.
            locomotion: to move.
            config: returns the oscillators' configuration of a new walk.
        """
        self._node = node
        self._locomotion = locomotion
        self._config = config
        self._active = self._has_walked = self._leaving = False
        self._rejected: Counter[str] = Counter()
        self._messages = OutputMessages()
        self._trajectory = node.create_publisher(JointTrajectory, 'joint_trajectory', COMMAND)
        self._state = node.create_publisher(CpgState, 'cpg/state', COMMAND)
        self._max_age_ns = round(node.get_parameter('max_age').value * 1e9)
        wanted = Input(CpgCommand, self._max_age_ns, command_from_message)
        self._samples = NewestSamples(node, {'cpg/command': wanted})
        self._ticker: Ticker | None = None
        self._start: MeasuredStart | None = None

    def configure(self) -> None:
        """Hold the standing pose from now on, or find out how far away it is."""
        if self._node.get_parameter('start_from').value == MEASURED:
            self._locomotion.wait(self._config())
            self._start = MeasuredStart(self._node, self._max_age_ns)
        else:
            self._locomotion.hold(self._config())
        phase_ns = round(self._node.get_parameter('phase').value * 1e9)
        self._ticker = Ticker(self._node, CONTROL_PERIOD_NS, self._on_tick, phase_ns)

    def activate(self) -> None:
        """Play commands from now on."""
        self._active, self._has_walked = True, False

    def deactivate(self) -> None:
        """Play no more commands: bring the robot to its standing pose."""
        self._active = False

    def cleanup_fault(self) -> str:
        """Say why the robot cannot be left to itself yet; '' if it can."""
        if self._locomotion.motion in (Motion.STANDING, Motion.WAITING):
            return ''
        return f'the robot is {self._locomotion.motion}, expected it to stand: wait a moment'

    def release(self) -> None:
        """Tick no more."""
        self._active = self._leaving = False
        self._drop_start()
        if self._ticker is not None:
            self._ticker.destroy()
            self._ticker = None

    def shutdown(self) -> None:
        """Bring the robot to its standing pose, then tick no more."""
        if self.cleanup_fault() and self._ticker is not None:
            self._active, self._leaving = False, True
        else:
            self.release()

    def health(self) -> Health:
        """Return what the diagnostics show."""
        values: dict[str, object] = {
            'active': self._active,
            'rejected': self._rejected.total(),
            **self._rejected,
            **self._samples.values(),
        }
        values |= self._start.values() if self._start is not None else {}
        values |= self._ticker.meter.values() if self._ticker is not None else {}
        fault = self._fault()
        level = DiagnosticStatus.WARN if fault else DiagnosticStatus.OK
        return level, fault or str(self._locomotion.motion), values

    def _fault(self) -> str:
        if self._start is not None:
            return self._start.fault()
        if not self._active:
            return 'not active'
        return self._samples.fault() or self._samples.contest()

    def _on_tick(self, tick: Tick) -> None:
        """Advance one period with the newest command, or stop where there is none."""
        if self._knows_the_joints():
            newest = self._samples.take() if self._active else None
            targets = self._walk(newest['cpg/command']) if newest else self._locomotion.stop()
            self._trajectory.publish(self._messages.trajectory(targets, tick.stamp_ns))
        end_ns = tick.stamp_ns + CONTROL_PERIOD_NS
        self._state.publish(self._messages.state(self._locomotion.cpg, end_ns))
        if self._leaving and self._locomotion.motion is Motion.STANDING:
            self.release()

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
            self._locomotion.restart(self._config())
        try:
            targets = self._locomotion.walk(command)
        except ValueError as error:
            self._rejected[fault_kind(error)] += 1
            self._node.get_logger().error(f'{error}; the robot stops', throttle_duration_sec=1.0)
            return self._locomotion.stop()
        walks = self._locomotion.motion is Motion.WALKING
        if walks and not self._has_walked and self._ticker is not None:
            self._ticker.meter.restart()  # what counts is how the robot walks
            self._has_walked = True
        return targets
