# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The sensor table: one row per channel, from the model's sensors to what an agent observes.

All else follows from a row: what is read from MuJoCo, the messages of its topics and what a driver
does to them, what a set subscribes to and its input size, the sensor contract, the factors of an
experiment and the tables of the documentation. A new sensor is a row here and a sensor in
hexapod.xml that bears the name of its reading.
"""

import math

import numpy as np

from hexapod_sim.channel import JOINT_TYPE, Channel, Derived, Field, Numbers
from hexapod_sim.robot import (
    BASE_FRAME,
    FOOT_FRAMES,
    GRAVITY,
    HEIGHT_FRAME,
    HEIGHT_RANGE_MAX,
    IMU_FRAME,
    JOINTS,
    LEGS,
    NO_LOAD_SPEED,
    ODOM_FRAME,
    TORQUE_LIMIT,
    TOTAL_MASS,
)

PREVIOUS_ACTION = 'previous_action'
_ACTIONS = 30
_FEET = tuple(f'{leg}_foot' for leg in LEGS)


def foot_forces(wrench: Numbers) -> Numbers:
    """Return normal and friction forces of the feet from their force vectors.

    Args:
        wrench: Force of the ground on each foot (6, 3) [N], z along the normal of a level floor.

    Returns:
        Six normal forces, then six friction magnitudes (12,) [N].
    """
    return np.concatenate((np.abs(wrench[:, 2]), np.hypot(wrench[:, 0], wrench[:, 1])))


def _x_y_z_w(wxyz: Numbers) -> Numbers:
    """Turn MuJoCo's order of a quaternion into that of ROS."""
    return wxyz[[1, 2, 3, 0]]


def _distance(ray: Numbers) -> Numbers:
    """Return the range finder's distance [m], the end of its range where it sees nothing.

    MuJoCo gives -1 where the ray meets nothing.
    """
    seen = 0.0 <= ray[0] <= HEIGHT_RANGE_MAX
    return ray.copy() if seen else np.array([HEIGHT_RANGE_MAX])


def _force(feet: Numbers) -> Numbers:
    """Force of the ground on each foot (6, 3) [N], axes parallel to odom, z up."""
    return feet.reshape(-1, 4)[:, 1:].copy()


def _contact(feet: Numbers) -> Numbers:
    """1 where a foot touches the ground, in however many places, else 0 (6,)."""
    return np.minimum(feet.reshape(-1, 4)[:, 0], 1.0)


def _joints(kind: str) -> tuple[str, ...]:
    return tuple(f'{joint}_{kind}' for joint in JOINTS)


def _rates(scale: float = 0.0, limit: float = math.inf) -> Field:
    return Field('angular_velocity', 'angular_velocity', 3, 'rad/s', scale, limit)


_ACCELERATION = Field('linear_acceleration', 'linear_acceleration', 3, 'm/s²')
_JOINT_NAMES = {'name': list(JOINTS)}
_INFRARED = 1  # sensor_msgs/Range
_NOT_GIVEN = [-1.0] + [0.0] * 8  # covariance of what a message does not measure

CHANNELS = (
    Channel(
        '', 'joint angles and velocities', ('joint_states',), JOINT_TYPE,
        (
            Field('position', 'joint_angles', 18, 'rad', 1.0, math.pi / 2,
                  model_sensors=_joints('angle')),
            Field('velocity', 'joint_velocities', 18, 'rad/s', NO_LOAD_SPEED, 2 * NO_LOAD_SPEED,
                  model_sensors=_joints('velocity')),
        ),
        'joint encoders', constants=_JOINT_NAMES,
    ),
    Channel(
        '', 'oscillator state', ('cpg/state',), 'hexapod_interfaces/msg/CpgState',
        (Field('x', 'oscillator', 6, '1', 1.2, 2.0), Field('y', 'oscillator', 6, '1', 1.2, 2.0)),
        'none (computed)', 'cpg',
    ),
    Channel(
        '', 'previous action', (), '', (Field('', PREVIOUS_ACTION, _ACTIONS, '1', 1.0),),
        'none', 'agent',
    ),
    Channel(
        '', 'line offset', ('line_offset',), 'hexapod_interfaces/msg/LineOffset',
        (Field('offset', 'line_offset', 1, 'm', 1.0, 10.0),),
        'line sensor or localisation', 'task', (ODOM_FRAME,),
    ),
    Channel(
        'A', 'joint torques', ('joint_torques',), JOINT_TYPE,
        (Field('effort', 'joint_torques', 18, 'N·m', TORQUE_LIMIT, 2 * TORQUE_LIMIT,
               model_sensors=_joints('torque')),),
        '18 current sensors', constants=_JOINT_NAMES,
    ),
    Channel(
        'B', 'body linear velocity', ('body/twist',), 'geometry_msgs/msg/TwistStamped',
        (
            Field('twist.linear', 'linear_velocity', 3, 'm/s', 0.5, 2.0),
            Field('twist.angular', 'angular_velocity', 3, 'rad/s'),
        ),
        'estimator or optical flow', frames=(BASE_FRAME,),
    ),
    Channel(
        'C', 'body orientation', ('imu/data',), 'sensor_msgs/msg/Imu',
        (
            Field('orientation', 'orientation', 4, '1', 1.0, kind='quaternion', convert=_x_y_z_w),
            _rates(),
            _ACCELERATION,
        ),
        'IMU with fusion', frames=(IMU_FRAME,),
    ),
    Channel(
        'D', 'body angular velocity', ('imu/data_raw',), 'sensor_msgs/msg/Imu',
        (_rates(2.0, 8.0), _ACCELERATION),
        'IMU', frames=(IMU_FRAME,), constants={'orientation_covariance': _NOT_GIVEN},
    ),
    Channel(
        'E', 'body height', ('body/height',), 'sensor_msgs/msg/Range',
        (Field('range', 'height', 1, 'm', 0.05, HEIGHT_RANGE_MAX, 0.13, convert=_distance,
               single=True),),
        'range finder', frames=(HEIGHT_FRAME,),
        constants={'radiation_type': _INFRARED, 'field_of_view': 0.44, 'min_range': 0.02,
                   'max_range': HEIGHT_RANGE_MAX},
    ),
    Channel(
        'F', 'foot forces', tuple(f'foot_force/{leg}' for leg in LEGS),
        'geometry_msgs/msg/WrenchStamped',
        (Field('wrench.force', 'foot_wrench', 3, 'N', 20.0, 8 * TOTAL_MASS * GRAVITY,
               model_sensors=_FEET, convert=_force),),
        'six load cells', frames=FOOT_FRAMES, derived=Derived('foot_forces', 12, foot_forces),
    ),
    Channel(
        'G', 'foot contacts', ('foot_contacts',), 'hexapod_interfaces/msg/FootContacts',
        (Field('contact', 'foot_contacts', 6, '1', 1.0, 1.0, kind='switch',
               model_sensors=_FEET, convert=_contact),),
        'six switches',
    ),
)  # fmt: skip
LETTERS = ''.join(channel.letter for channel in CHANNELS)
SENSORS = {channel.key: channel for channel in CHANNELS if channel.is_measured}
"""Channels that a device measures, by key: what can be noisy, late or replaced by a driver."""
MEASURED: dict[str, Field] = {
    field.reading: field
    for channel in CHANNELS
    if channel.source == 'robot'
    for field in channel.fields
}
"""What is read from the model's sensors, by reading."""
