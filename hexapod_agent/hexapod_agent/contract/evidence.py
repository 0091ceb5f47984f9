# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What was heard of the sensor topics: who offers them, and decoded samples with their times."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from hexapod_sim.channel import Channel
from hexapod_sim.message_fields import read
from numpy.typing import NDArray

_NANOSECONDS = 1_000_000_000


@dataclass(frozen=True)
class Offer:
    """One publisher of a topic."""

    publisher: str
    """Its node, fully qualified; empty for a bag."""
    message_type: str
    """Such as 'sensor_msgs/msg/Imu'."""
    reliable: bool = True
    """Whether it sends lost messages again; best effort otherwise."""


@dataclass(frozen=True)
class Sample:
    """One message, decoded."""

    arrival_ns: int
    """When it came, on one clock for all topics."""
    stamp_ns: int
    """When its driver says that it was measured."""
    frame: str
    """Frame of its header."""
    names: tuple[str, ...]
    """Joint names of a message that has them."""
    values: Mapping[str, NDArray[np.float64]]
    """Numbers of each field, by its path such as 'twist.linear'."""


@dataclass(frozen=True)
class TopicEvidence:
    """What was heard of one topic."""

    topic: str
    """Its name on the graph or in the bag, after remapping."""
    offers: tuple[Offer, ...] = ()
    """Its publishers."""
    samples: tuple[Sample, ...] = ()
    """In the order of their arrival."""


@dataclass(frozen=True)
class Evidence:
    """What was heard of all topics of a set."""

    topics: Mapping[str, TopicEvidence]
    """By the relative names of the sensor table."""
    end_ns: int
    """When listening ended, on the clock of the arrivals."""


def sample(message: Any, paths: Iterable[str], arrival_ns: int) -> Sample:
    """Take the numbers that are checked out of a message of any ROS library.

    Args:
        message: has a header, and the attributes that the paths name.
        paths: fields to take, dots between nested ones.
        arrival_ns: when it came.
    """
    stamp = message.header.stamp
    return Sample(
        arrival_ns=arrival_ns,
        stamp_ns=int(stamp.sec) * _NANOSECONDS + int(stamp.nanosec),
        frame=str(message.header.frame_id),
        names=tuple(getattr(message, 'name', ())),
        values={path: read(message, path) for path in paths},
    )


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
