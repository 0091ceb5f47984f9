# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The pattern generator in lock-step: one control period per command, by stamp."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from diagnostic_msgs.msg import DiagnosticStatus
from hexapod_interfaces.msg import CpgCommand, CpgState
from hexapod_interfaces.srv import ResetEpisode
from hexapod_node.intra_process import LockStepPublisher, LockStepSubscription
from hexapod_node.invalid_message import fault_kind
from hexapod_node.matching import listeners_of, unmatched
from hexapod_node.stamp_gate import DuePeriod
from hexapod_node.stamps import to_nanoseconds
from hexapod_sim.robot import CONTROL_PERIOD_NS
from numpy.typing import NDArray
from trajectory_msgs.msg import JointTrajectory

from hexapod_cpg.locomotion import Locomotion, Motion
from hexapod_cpg.nodes.messages import OutputMessages, command_from_message
from hexapod_cpg.oscillator import HopfConfig

if TYPE_CHECKING:
    from hexapod_node.diagnostics import Health
    from rclpy.node import Node


class LockStepCpg:
    """Answers the command of the period that is due with its trajectory and the next state.

    Active, it plays the command; inactive, it goes on with the way to the standing pose.
    """

    def __init__(
        self, node: Node, locomotion: Locomotion, config: Callable[[], HopfConfig]
    ) -> None:
        """Subscribe and offer `~/reset`.

        Args:
            node: that has the endpoints.
            locomotion: to move.
            config: returns the oscillators' configuration of a new episode.
        """
        self._node = node
        self._locomotion = locomotion
        self._config = config
        self._active = False
        self._rejected: Counter[str] = Counter()
        self._due = DuePeriod(CONTROL_PERIOD_NS)
        self._messages = OutputMessages()
        self._trajectory = LockStepPublisher(node, JointTrajectory, 'joint_trajectory')
        self._state = LockStepPublisher(node, CpgState, 'cpg/state')
        LockStepSubscription(node, CpgCommand, 'cpg/command', self._on_command)
        node.create_service(ResetEpisode, '~/reset', self._on_reset)

    def configure(self) -> None:
        """Hold the standing pose."""
        self._locomotion.stand(self._config())

    def activate(self) -> None:
        """Play commands from now on."""
        self._active = True

    def deactivate(self) -> None:
        """Play no more commands."""
        self._active = False

    def cleanup_fault(self) -> str:
        """Say why the robot cannot be left to itself yet; '' if it can."""
        if self._locomotion.motion is Motion.STANDING:
            return ''
        return 'expected it to stand: answer further commands first, or shut the node down'

    def release(self) -> None:
        """Answer nobody until the next reset."""
        self._active = False
        self._due.stop()

    shutdown = release

    def health(self) -> Health:
        """Return what the diagnostics show."""
        values: dict[str, object] = {
            'active': self._active,
            'rejected': self._rejected.total(),
            **self._rejected,
            **vars(self._due.counts),
        }
        if self._rejected.total() or any(vars(self._due.counts).values()):
            return DiagnosticStatus.WARN, 'commands came that were not due', values
        return DiagnosticStatus.OK, 'in step', values

    def _on_reset(
        self, request: ResetEpisode.Request, response: ResetEpisode.Response
    ) -> ResetEpisode.Response:
        """Put the oscillators at the start of the gait and publish their state."""
        response.start = request.start
        listeners = listeners_of(request.topics, request.subscriptions)
        response.message = unmatched([self._trajectory, self._state], listeners)
        if not self._active:
            response.message = 'cpg is not active: expected `ros2 lifecycle set cpg activate`'
        response.success = not response.message
        if response.success:
            start_ns = to_nanoseconds(request.start)
            self._locomotion.stand(self._config())
            self._due.start(start_ns)
            self._state.publish(self._messages.state(self._locomotion.cpg, start_ns))
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
            self._node.get_logger().error(f'{error}; the period is not played')
            return
        next_ns = stamp_ns + CONTROL_PERIOD_NS
        self._due.start(next_ns)
        self._trajectory.publish(self._messages.trajectory(targets, stamp_ns))
        self._state.publish(self._messages.state(self._locomotion.cpg, next_ns))

    def _play(self, message: CpgCommand) -> NDArray[np.float64]:
        if not self._active:
            return self._locomotion.stop()
        return self._locomotion.play(command_from_message(message))
