# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What goes wrong with real drivers, each by name, to show that it is found."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from hexapod_sim.channel import Channel
from hexapod_sim.joint_layout import JOINT_FIELDS
from hexapod_sim.message_fields import read, write
from hexapod_sim.sensor_table import CHANNELS
from hexapod_sim.units import OTHER_UNITS

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


def faults(channel: Channel) -> dict[str, Callable[[Any], None]]:
    """Return what can go wrong with the messages of a channel; each changes one in place."""
    observed = channel.observed[0]
    found: dict[str, Callable[[Any], None]] = {}
    if observed.kind != 'switch':
        found['nan'] = _nan(observed.path)
    if channel.has_joints:
        found |= {'wrong_length': _wrong_length, 'wrong_names': _wrong_names}
    elif channel.frames:
        found['wrong_frame'] = _wrong_frame
    if observed.kind == 'quaternion':
        found['bad_quaternion'] = _scaled(observed.path, 1.2)
    if 'linear_acceleration' in (field.path for field in channel.fields):
        found['flipped_gravity'] = _scaled('linear_acceleration', -1.0)
    # An orientation has no unit: what comes along with it does.
    measured = next((field for field in channel.fields if field.unit != '1'), None)
    if measured is not None:
        factors = [factor for _, factor in OTHER_UNITS[measured.unit]]
        found['wrong_unit'] = _scaled(measured.path, max(factors))
    return found


def fault_names(channel: Channel) -> tuple[str, ...]:
    """Return the names of all faults that a channel's driver can have."""
    return (*_OF_THE_DRIVER, *faults(channel))


DEVICES = {
    channel.device_topic: channel for channel in CHANNELS if channel.source in ('robot', 'task')
}
"""Channels that a driver can take the place of, by the topic of their device."""
ALL_FAULTS = tuple(
    dict.fromkeys(name for channel in DEVICES.values() for name in fault_names(channel))
)
