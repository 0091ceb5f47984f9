# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The fields of the messages that the sensor table's readings come from."""

from hexapod_sim.channel import Channel

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


def checked_paths(channel: Channel) -> tuple[str, ...]:
    """Return the paths of all fields that are taken out of a message to check it."""
    own = tuple(field.path for field in channel.observed)
    return own + _FURTHER.get(channel.message_type, ())
