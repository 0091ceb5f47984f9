# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Node `sim`: the simulated robot, with the topics that a real robot's drivers would have."""

from __future__ import annotations

from array import array
from collections.abc import Sequence

from diagnostic_msgs.msg import DiagnosticStatus
from hexapod_interfaces.msg import LineOffset, StepOutcome
from hexapod_interfaces.srv import ResetEpisode
from hexapod_node.diagnostics import Diagnostics, Health
from hexapod_node.matching import unheard
from hexapod_node.parameters import ConfigParameters, Parameter, declare
from hexapod_node.qos import LOCK_STEP
from hexapod_node.spin import run
from hexapod_node.stamp_gate import DuePeriod
from hexapod_node.stamps import time_message, to_nanoseconds
from nav_msgs.msg import Odometry
from rclpy.node import Node
from rosgraph_msgs.msg import Clock
from trajectory_msgs.msg import JointTrajectory

from hexapod_sim.messages import SENSOR_TOPICS, fill_odometry, new_odometry, targets_from_message
from hexapod_sim.robot import CONTROL_PERIOD_NS, ODOM_FRAME
from hexapod_sim.sensors import read
from hexapod_sim.task import LineTask, Outcome, TaskConfig
from hexapod_sim.viewer import Viewer

PARAMETERS = (
    Parameter('viewer', False, 'show the robot in a window, in real time; needs a display'),
)


class SimNode(Node):
    """Steps the physics once per joint trajectory and publishes what somebody listens to."""

    def __init__(self) -> None:
        super().__init__('sim')
        declare(self, PARAMETERS)
        self._config = ConfigParameters(self, TaskConfig, 'task')
        self._task = LineTask(self._config.get())
        shown = self.get_parameter('viewer').value
        self._viewer = Viewer(self._task.simulation) if shown else None
        self._now_ns = 0
        self._due = DuePeriod(CONTROL_PERIOD_NS)
        self._rejected = 0
        self._sensors = [
            (
                sensor,
                sensor.new(),
                self.create_publisher(sensor.message_type, sensor.name, LOCK_STEP),
            )
            for sensor in SENSOR_TOPICS
        ]
        self._line_offset = LineOffset()
        self._line_offset.header.frame_id = ODOM_FRAME
        self._line_offset_publisher = self.create_publisher(LineOffset, 'line_offset', LOCK_STEP)
        self._outcome = StepOutcome()
        self._outcome_publisher = self.create_publisher(StepOutcome, 'step_outcome', LOCK_STEP)
        self._odometry = new_odometry()
        self._odometry_publisher = self.create_publisher(Odometry, 'odom', LOCK_STEP)
        # Relative: in the root namespace this is /clock, and workers side by side do not clash.
        self._clock_publisher = self.create_publisher(Clock, 'clock', LOCK_STEP)
        self._publishers = [
            *(publisher for _, _, publisher in self._sensors),
            self._line_offset_publisher,
            self._outcome_publisher,
            self._odometry_publisher,
            self._clock_publisher,
        ]
        self.create_subscription(
            JointTrajectory, 'joint_trajectory', self._on_joint_trajectory, LOCK_STEP
        )
        self.create_service(ResetEpisode, '~/reset', self._on_reset)
        Diagnostics(self, self._health)

    def destroy_node(self) -> None:
        """Close the window, then the node."""
        if self._viewer is not None:
            self._viewer.close()
        super().destroy_node()

    def _on_reset(
        self, request: ResetEpisode.Request, response: ResetEpisode.Response
    ) -> ResetEpisode.Response:
        """Put the robot at the seeded start of an episode, a period after the last sample."""
        listeners = dict(zip(request.topics, request.subscriptions, strict=True))
        response.message = unheard(self._publishers, listeners)
        response.success = not response.message
        if response.success:
            self._task.config = self._config.get()
            outcome = self._task.reset(request.seed)
            self._now_ns = max(self._now_ns + CONTROL_PERIOD_NS, to_nanoseconds(request.start))
            self._due.start(self._now_ns)
            self._publish(outcome)
        response.start = time_message(self._now_ns)
        return response

    def _on_joint_trajectory(self, message: JointTrajectory) -> None:
        """Advance one period, if the trajectory is the one of the period that is due."""
        if not self._due.admit(to_nanoseconds(message.header.stamp)):
            return
        try:
            targets = targets_from_message(message)
        except ValueError as error:
            self._rejected += 1
            self.get_logger().error(f'{error}; the period is not simulated')
            return
        outcome = self._task.advance(targets)
        self._now_ns += CONTROL_PERIOD_NS
        if outcome.terminated or outcome.truncated:
            self._due.stop()
        else:
            self._due.start(self._now_ns)
        self._publish(outcome)

    def _publish(self, outcome: Outcome) -> None:
        """Publish the sample of now: sensors first, then what they earned, then the clock."""
        if self._viewer is not None:
            self._viewer.show()
        stamp = time_message(self._now_ns)
        heard = [entry for entry in self._sensors if entry[2].get_subscription_count()]
        needed = {key for sensor, _, _ in heard for key in sensor.readings}
        readings = read(self._task.simulation, needed)
        for sensor, message, publisher in heard:
            message.header.stamp = stamp
            sensor.fill(message, readings)
            publisher.publish(message)
        if self._line_offset_publisher.get_subscription_count():
            self._line_offset.header.stamp = stamp
            self._line_offset.offset = self._task.line_offset
            self._line_offset_publisher.publish(self._line_offset)
        if self._odometry_publisher.get_subscription_count():
            fill_odometry(self._odometry, self._task.simulation)
            self._odometry.header.stamp = stamp
            self._odometry_publisher.publish(self._odometry)
        self._publish_outcome(outcome)
        if self._clock_publisher.get_subscription_count():
            self._clock_publisher.publish(Clock(clock=stamp))

    def _publish_outcome(self, outcome: Outcome) -> None:
        message = self._outcome
        message.header.stamp = time_message(self._now_ns)
        message.step = outcome.step
        message.reward = outcome.reward
        message.term_names = list(outcome.terms)
        message.term_values = array('d', outcome.terms.values())
        message.terminated = outcome.terminated
        message.truncated = outcome.truncated
        message.cause = outcome.cause
        self._outcome_publisher.publish(message)

    def _health(self) -> Health:
        faults = vars(self._due.counts) | {'rejected': self._rejected}
        if any(faults.values()):
            return DiagnosticStatus.WARN, 'trajectories came that were not due', faults
        return DiagnosticStatus.OK, 'in step', faults


def main(args: Sequence[str] | None = None) -> None:
    """Run the node until a signal comes."""
    run(SimNode, args)
