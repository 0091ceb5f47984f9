# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What goes wrong with real drivers, each by name, to show that it is found."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from hexapod_sim.driver_channels import CHANNELS, JOINT_FIELDS, read, write
from hexapod_sim.robot import GRAVITY

# Another unit of each channel's first reading: how many of it make one of ours.
_OTHER_UNITS = {
    'position': 180.0 / math.pi,  # degrees
    'offset': 1000.0,  # mm
    'effort': 1000.0,  # N mm
    'twist.linear': 1000.0,  # mm/s
    'angular_velocity': 180.0 / math.pi,  # degrees/s
    'range': 1000.0,  # mm
    'wrench.force': 1000.0 / GRAVITY,  # gf
    'linear_acceleration': 1.0 / GRAVITY,  # g
}
STOPPED = 'stopped'
STALE_STAMPS = 'stale_stamps'
# In the driver, not in its messages.
_OF_THE_DRIVER = (STOPPED, STALE_STAMPS)


def _wrong_length(message: Any) -> None:
    for field in JOINT_FIELDS:
        setattr(message, field, getattr(message, field)[:-1])


def _nan(path: str) -> Callable[[Any], None]:
    def fault(message: Any) -> None:
        values = read(message, path)
        values[0] = np.nan
        write(message, path, values)

    return fault


def _scaled(path: str, factor: float) -> Callable[[Any], None]:
    def fault(message: Any) -> None:
        write(message, path, factor * read(message, path))

    return fault


def _wrong_frame(message: Any) -> None:
    message.header.frame_id = 'wrong_frame'


def _wrong_names(message: Any) -> None:
    message.name = [f'joint_{index}' for index in range(len(message.name))]


def faults(channel: str) -> dict[str, Callable[[Any], None]]:
    """Return what can go wrong with the messages of a channel; each changes one in place."""
    driver = CHANNELS[channel]
    reading = driver.readings[0]
    found: dict[str, Callable[[Any], None]] = {}
    if reading.kind != 'switch':
        found['nan'] = _nan(reading.path)
    if driver.has_joints:
        found |= {'wrong_length': _wrong_length, 'wrong_names': _wrong_names}
    elif reading.kind != 'switch':
        found['wrong_frame'] = _wrong_frame
    if reading.kind == 'quaternion':
        found['bad_quaternion'] = _scaled(reading.path, 1.2)
    if channel.startswith('imu/'):
        found['flipped_gravity'] = _scaled('linear_acceleration', -1.0)
    unit = 'linear_acceleration' if reading.kind == 'quaternion' else reading.path
    if unit in _OTHER_UNITS:
        found['wrong_unit'] = _scaled(unit, _OTHER_UNITS[unit])
    return found


def fault_names(channel: str) -> tuple[str, ...]:
    """Return the names of all faults that a channel's driver can have."""
    return (*_OF_THE_DRIVER, *faults(channel))


ALL_FAULTS = tuple(dict.fromkeys(name for channel in CHANNELS for name in fault_names(channel)))
