# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The fields of the messages that the sensor table's readings come from."""

from __future__ import annotations

from dataclasses import dataclass

from hexapod_agent.observation import Channel

# Fields of each reading and how many numbers they have.
_FIELDS: dict[str, tuple[tuple[str, int], ...]] = {
    'joint_angles': (('position', 18),),
    'joint_velocities': (('velocity', 18),),
    'joint_torques': (('effort', 18),),
    'oscillator': (('x', 6), ('y', 6)),
    'line_offset': (('offset', 1),),
    'linear_velocity': (('twist.linear', 3),),
    'orientation': (('orientation', 4),),
    'angular_velocity': (('angular_velocity', 3),),
    'height': (('range', 1),),
    'foot_forces': (('wrench.force', 3),),
    'foot_contacts': (('contact', 6),),
}
ACCELERATION = 'linear_acceleration'
ACCELERATION_COVARIANCE = 'linear_acceleration_covariance'
ORIENTATION_COVARIANCE = 'orientation_covariance'
ANGULAR_VELOCITY_COVARIANCE = 'angular_velocity_covariance'
# What says of an observed field whether the device gives it at all (REP-145).
COVARIANCES = {
    'orientation': ORIENTATION_COVARIANCE,
    'angular_velocity': ANGULAR_VELOCITY_COVARIANCE,
}
RANGE_LIMITS = ('min_range', 'max_range')
# What the agent does not observe but the check needs to judge what it does.
_FURTHER = {
    'sensor_msgs/msg/Imu': (
        ACCELERATION,
        ACCELERATION_COVARIANCE,
        ANGULAR_VELOCITY_COVARIANCE,
        ORIENTATION_COVARIANCE,
    ),
    'sensor_msgs/msg/Range': RANGE_LIMITS,
}
JOINT_TYPE = 'sensor_msgs/msg/JointState'


@dataclass(frozen=True)
class Field:
    """One field that is observed, with what the sensor table says of its reading."""

    path: str
    size: int
    unit: str
    scale: float
    center: float
    limit: float


def observed_fields(channel: Channel) -> tuple[Field, ...]:
    """Return the fields that a channel reads from each message of its topics."""
    centers = channel.centers or (0.0,) * len(channel.readings)
    rows = zip(
        channel.readings, channel.units, channel.scales, centers, channel.limits, strict=True
    )
    return tuple(
        Field(path, size, unit, scale, center, limit)
        for reading, unit, scale, center, limit in rows
        for path, size in _FIELDS[reading]
    )


def checked_paths(channel: Channel) -> tuple[str, ...]:
    """Return the paths of all fields that are taken out of a message to check it."""
    own = tuple(field.path for field in observed_fields(channel))
    return own + _FURTHER.get(channel.message_type, ())
