# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Sensor readings as the ROS messages that real devices publish, and joint targets back."""

from __future__ import annotations

from array import array
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from geometry_msgs.msg import TwistStamped, Vector3, WrenchStamped
from hexapod_interfaces.msg import FootContacts
from hexapod_node.invalid_message import InvalidMessageError
from nav_msgs.msg import Odometry
from numpy.typing import NDArray
from sensor_msgs.msg import Imu, JointState, Range
from trajectory_msgs.msg import JointTrajectory

from hexapod_sim.robot import (
    BASE_FRAME,
    FOOT_FRAMES,
    HEIGHT_FRAME,
    HEIGHT_RANGE_MAX,
    IMU_FRAME,
    JOINTS,
    LEGS,
    ODOM_FRAME,
    SUBSTEPS,
)
from hexapod_sim.sensors import read
from hexapod_sim.simulation import Simulation

Readings = Mapping[str, NDArray[np.float64]]

# Least distance and cone of a usual time-of-flight device looking down.
_RANGE_MIN_M = 0.02
_RANGE_FIELD_OF_VIEW_RAD = 0.44

# REP-145: the first covariance is -1 where the device does not give the quantity.
_NOT_GIVEN = np.array([-1.0] + [0.0] * 8)


@dataclass(frozen=True)
class SensorTopic:
    """One sensor topic of the robot: what it carries and how a message of it is filled."""

    name: str
    message_type: type
    readings: tuple[str, ...]
    new: Callable[[], Any]
    """Makes a message with everything that never changes."""
    fill: Callable[[Any, Readings], None]
    """Writes the readings into it."""


def _joints(message: JointState, readings: Readings) -> None:
    message.position = array('d', readings['joint_angles'].tobytes())
    message.velocity = array('d', readings['joint_velocities'].tobytes())


def _torques(message: JointState, readings: Readings) -> None:
    message.effort = array('d', readings['joint_torques'].tobytes())


def _twist(message: TwistStamped, readings: Readings) -> None:
    _set_vector(message.twist.linear, readings['linear_velocity'])
    _set_vector(message.twist.angular, readings['angular_velocity'])


def _imu_raw(message: Imu, readings: Readings) -> None:
    _set_vector(message.angular_velocity, readings['angular_velocity'])
    _set_vector(message.linear_acceleration, readings['linear_acceleration'])


def _imu(message: Imu, readings: Readings) -> None:
    _imu_raw(message, readings)
    orientation = message.orientation
    orientation.x, orientation.y, orientation.z, orientation.w = readings['orientation'].tolist()


def _height(message: Range, readings: Readings) -> None:
    message.range = float(readings['height'][0])


def _contacts(message: FootContacts, readings: Readings) -> None:
    message.contact = (readings['foot_contacts'] > 0.5).tolist()


def _wrench(leg: int) -> Callable[[WrenchStamped, Readings], None]:
    def fill(message: WrenchStamped, readings: Readings) -> None:
        _set_vector(message.wrench.force, readings['foot_wrench'][leg])

    return fill


def _set_vector(vector: Vector3, value: NDArray[np.float64]) -> None:
    vector.x, vector.y, vector.z = value.tolist()


def _in_frame(kind: type, frame: str, **fields: Any) -> Callable[[], Any]:
    def new() -> Any:
        message = kind(**fields)
        message.header.frame_id = frame
        return message

    return new


def _new_range() -> Range:
    message = Range(
        radiation_type=Range.INFRARED,
        field_of_view=_RANGE_FIELD_OF_VIEW_RAD,
        min_range=_RANGE_MIN_M,
        max_range=HEIGHT_RANGE_MAX,
    )
    message.header.frame_id = HEIGHT_FRAME
    return message


_new_joints = _in_frame(JointState, '', name=list(JOINTS))

SENSOR_TOPICS: tuple[SensorTopic, ...] = (
    SensorTopic(
        'joint_states', JointState, ('joint_angles', 'joint_velocities'), _new_joints, _joints
    ),
    SensorTopic('joint_torques', JointState, ('joint_torques',), _new_joints, _torques),
    SensorTopic(
        'body/twist',
        TwistStamped,
        ('linear_velocity', 'angular_velocity'),
        _in_frame(TwistStamped, BASE_FRAME),
        _twist,
    ),
    SensorTopic(
        'imu/data',
        Imu,
        ('orientation', 'angular_velocity', 'linear_acceleration'),
        _in_frame(Imu, IMU_FRAME),
        _imu,
    ),
    SensorTopic(
        'imu/data_raw',
        Imu,
        ('angular_velocity', 'linear_acceleration'),
        _in_frame(Imu, IMU_FRAME, orientation_covariance=_NOT_GIVEN),
        _imu_raw,
    ),
    SensorTopic('body/height', Range, ('height',), _new_range, _height),
    *(
        SensorTopic(
            f'foot_force/{leg}',
            WrenchStamped,
            ('foot_wrench',),
            _in_frame(WrenchStamped, FOOT_FRAMES[index]),
            _wrench(index),
        )
        for index, leg in enumerate(LEGS)
    ),
    SensorTopic(
        'foot_contacts', FootContacts, ('foot_contacts',), _in_frame(FootContacts, ''), _contacts
    ),
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
