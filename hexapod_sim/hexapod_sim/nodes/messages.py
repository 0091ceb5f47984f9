# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Sensor readings as the ROS messages that real devices publish, and joint targets back."""

from array import array
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from geometry_msgs.msg import Vector3
from hexapod_interfaces.msg import StepOutcome
from hexapod_node.invalid_message import InvalidMessageError
from hexapod_node.raw_topics import message_class
from nav_msgs.msg import Odometry
from numpy.typing import NDArray
from trajectory_msgs.msg import JointTrajectory

from hexapod_sim.channel import Channel, Numbers
from hexapod_sim.message_fields import write
from hexapod_sim.robot import BASE_FRAME, JOINTS, ODOM_FRAME, SUBSTEPS
from hexapod_sim.sensor_table import CHANNELS
from hexapod_sim.sensors import read
from hexapod_sim.simulation import Simulation
from hexapod_sim.task import Outcome


@dataclass(frozen=True)
class SensorTopic:
    """One topic of a channel: makes its messages and writes readings into them."""

    channel: Channel
    index: int
    """Which of the channel's topics."""
    message_type: type

    @cached_property
    def name(self) -> str:
        """Relative name of the topic."""
        return self.channel.topics[self.index]

    def new(self) -> Any:
        """Return a message with everything that never changes."""
        message = self.message_type(**self.channel.constants)
        if self.channel.frames:
            message.header.frame_id = self.channel.frames[self.index]
        return message

    def fill(self, message: Any, readings: Mapping[str, Numbers]) -> None:
        """Write readings into a message; those of several topics have a row for each."""
        for field in self.channel.fields:
            numbers = readings[field.reading]
            write(message, field.path, numbers[self.index] if self._one_of_several else numbers)

    @cached_property
    def _one_of_several(self) -> bool:
        return len(self.channel.topics) > 1


SENSOR_TOPICS: tuple[SensorTopic, ...] = tuple(
    SensorTopic(channel, index, message_class(channel.message_type))
    for channel in CHANNELS
    if channel.is_measured
    for index in range(len(channel.topics))
)


def targets_from_message(message: JointTrajectory) -> NDArray[np.float64]:
    """Return the joint targets of one control period, rad. Shape: (SUBSTEPS, 18).

    Raises:
        InvalidMessageError: names, number of points or positions are not those of the robot, or
            a target is not finite; the text names the field.
    """
    if tuple(message.joint_names) != JOINTS:
        raise InvalidMessageError(
            'wrong_names',
            f'joint_trajectory: joint_names are {list(message.joint_names)}, expected '
            f'{list(JOINTS)}',
        )
    if len(message.points) != SUBSTEPS:
        raise InvalidMessageError(
            'wrong_length',
            f'joint_trajectory: {len(message.points)} points, expected {SUBSTEPS}',
        )
    targets = np.empty((SUBSTEPS, len(JOINTS)))
    for index, point in enumerate(message.points):
        if len(point.positions) != len(JOINTS):
            raise InvalidMessageError(
                'wrong_length',
                f'joint_trajectory: point {index} has {len(point.positions)} positions, '
                f'expected {len(JOINTS)}',
            )
        targets[index] = point.positions
    if not np.isfinite(targets).all():
        raise InvalidMessageError(
            'not_finite', 'joint_trajectory: positions hold NaN or infinity, expected radians'
        )
    return targets


def _set_vector(vector: Vector3, value: NDArray[np.float64]) -> None:
    vector.x, vector.y, vector.z = value.tolist()


def new_odometry() -> Odometry:
    """Return an odometry message with its frames."""
    message = Odometry(child_frame_id=BASE_FRAME)
    message.header.frame_id = ODOM_FRAME
    return message


def fill_odometry(message: Odometry, simulation: Simulation) -> None:
    """Write the true pose in odom and the true velocity in base_link."""
    readings = read(simulation, ('linear_velocity', 'angular_velocity'))
    pose, twist = message.pose.pose, message.twist.twist
    point, orientation = pose.position, pose.orientation
    point.x, point.y, point.z = simulation.position.tolist()
    orientation.x, orientation.y, orientation.z, orientation.w = simulation.orientation.tolist()
    _set_vector(twist.linear, readings['linear_velocity'])
    _set_vector(twist.angular, readings['angular_velocity'])


def fill_outcome(message: StepOutcome, outcome: Outcome) -> None:
    """Write what a control period earned."""
    message.step = outcome.step
    message.reward = outcome.reward
    message.term_names = list(outcome.terms)
    message.term_values = array('d', outcome.terms.values())
    message.terminated = outcome.terminated
    message.truncated = outcome.truncated
    message.cause = outcome.cause
