# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Node `cpg`: one command in, one joint trajectory and one oscillator state out."""

from __future__ import annotations

from collections.abc import Sequence

from diagnostic_msgs.msg import DiagnosticStatus
from hexapod_interfaces.msg import CpgCommand, CpgState
from hexapod_interfaces.srv import ResetEpisode
from hexapod_node.diagnostics import Diagnostics, Health
from hexapod_node.matching import unheard
from hexapod_node.parameters import ConfigParameters
from hexapod_node.qos import LOCK_STEP
from hexapod_node.spin import run
from hexapod_node.stamp_gate import DuePeriod
from hexapod_node.stamps import time_message, to_nanoseconds
from hexapod_sim.robot import CONTROL_PERIOD_NS
from rclpy.node import Node
from trajectory_msgs.msg import JointTrajectory

from hexapod_cpg.cpg import Cpg
from hexapod_cpg.messages import command_from_message, new_trajectory, targets_to_message
from hexapod_cpg.oscillator import HopfConfig


class CpgNode(Node):
    """The pattern generator and its mapping to joint angles, one control period per command."""

    def __init__(self) -> None:
        super().__init__('cpg')
        self._config = ConfigParameters(self, HopfConfig, 'cpg')
        self._cpg = Cpg(self._config.get())
        self._due = DuePeriod(CONTROL_PERIOD_NS)
        self._rejected = 0
        self._trajectory = new_trajectory()
        self._state = CpgState()
        self._trajectory_publisher = self.create_publisher(
            JointTrajectory, 'joint_trajectory', LOCK_STEP
        )
        self._state_publisher = self.create_publisher(CpgState, 'cpg/state', LOCK_STEP)
        self.create_subscription(CpgCommand, 'cpg/command', self._on_command, LOCK_STEP)
        self.create_service(ResetEpisode, '~/reset', self._on_reset)
        Diagnostics(self, self._health)

    def _on_reset(
        self, request: ResetEpisode.Request, response: ResetEpisode.Response
    ) -> ResetEpisode.Response:
        """Put the oscillators at the start of the gait and publish their state."""
        response.start = request.start
        listeners = dict(zip(request.topics, request.subscriptions, strict=True))
        response.message = unheard([self._trajectory_publisher, self._state_publisher], listeners)
        response.success = not response.message
        if response.success:
            self._cpg = Cpg(self._config.get())
            self._due.start(to_nanoseconds(request.start))
            self._publish_state(to_nanoseconds(request.start))
        return response

    def _on_command(self, message: CpgCommand) -> None:
        """Advance one period, if the command is the one of the period that is due."""
        stamp_ns = to_nanoseconds(message.header.stamp)
        if not self._due.admit(stamp_ns):
            return
        try:
            command = command_from_message(message)
        except ValueError as error:
            self._rejected += 1
            self.get_logger().error(f'{error}; the period is not played')
            return
        targets_to_message(self._cpg.advance(command), self._trajectory)
        self._trajectory.header.stamp = message.header.stamp
        self._trajectory_publisher.publish(self._trajectory)
        self._due.start(stamp_ns + CONTROL_PERIOD_NS)
        self._publish_state(stamp_ns + CONTROL_PERIOD_NS)

    def _publish_state(self, stamp_ns: int) -> None:
        self._state.header.stamp = time_message(stamp_ns)
        self._state.x = self._cpg.x
        self._state.y = self._cpg.y
        self._state_publisher.publish(self._state)

    def _health(self) -> Health:
        faults = vars(self._due.counts) | {'rejected': self._rejected}
        if any(faults.values()):
            return DiagnosticStatus.WARN, 'commands came that were not due', faults
        return DiagnosticStatus.OK, 'in step', faults


def main(args: Sequence[str] | None = None) -> None:
    """Run the node until a signal comes."""
    run(CpgNode, args)
