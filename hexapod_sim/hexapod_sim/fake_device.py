# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A device in place of a channel of the sim: its names, its quality and what is wrong with it."""

from array import array
from collections.abc import Callable, Mapping
from dataclasses import fields
from typing import Any

import numpy as np

from hexapod_sim.channel import Channel
from hexapod_sim.degradation import Degradation
from hexapod_sim.message_fields import read, write
from hexapod_sim.quality import Quality, check
from hexapod_sim.robot import JOINTS
from hexapod_sim.sensor_table import SENSORS
from hexapod_sim.units import OTHER_UNITS

OUR_ORDER, REVERSED, SHUFFLED = 'ours', 'reversed', 'shuffled'
STOPPED, STALE_STAMPS = 'stopped', 'stale_stamps'
_ACCELERATION = 'linear_acceleration'
_JOINT_FIELDS = ('position', 'velocity', 'effort')
DEVICES = {channel.device_topic: channel for channel in SENSORS.values()}
"""Channels that a driver can take the place of, by the topic of their device."""


class FakeDevice:
    """Turns messages of the sim into those of a device.

    Attributes:
        row: The channel that it measures.
    """

    def __init__(self, settings: Mapping[str, Any]) -> None:
        """Read the settings, named as the parameters of the node `fake_driver`.

        Raises:
            ValueError: One does not suit the channel; the text names it.
        """
        self.row = DEVICES[settings['channel']]
        quality = Quality(**{field.name: settings[field.name] for field in fields(Quality)})
        check({self.row.key: quality})
        self._own_topic: str = settings['topic'] or f'driver/{self.row.device_topic}'
        self._own_frame: str = settings['frame']
        self._prefix: str = settings['joint_prefix']
        self._order = _joint_order(self.row, settings)
        self._faults = faults(self.row)
        self.lines = {
            topic: Degradation(self.row, topic, quality, settings['seed'])
            for topic in self.row.topics
        }

    def own_topic(self, topic: str) -> str:
        """Return the device's own name of a topic of the sim."""
        return self._own_topic + topic.removeprefix(self.row.device_topic)

    def measure(self, message: Any, topic: str, stamp_ns: int) -> bool:
        """Take a message of the sim as the truth; return whether a sample has arrived."""
        truth = {field.reading: read(message, field.path) for field in self.row.fields}
        return self.lines[topic].sample(stamp_ns, truth)

    def fill(self, message: Any, topic: str, fault: str) -> None:
        """Turn a message of the sim into one of the device with its newest sample, in place."""
        for field in self.row.fields:
            write(message, field.path, self.lines[topic].newest[field.reading])
        if self._own_frame:
            leg = topic.removeprefix(self.row.device_topic).replace('/', '_')
            message.header.frame_id = self._own_frame + leg
        if self._order is not None:
            _reorder_joints(message, self._order, self._prefix)
        if fault in self._faults:
            self._faults[fault](message)


def faults(channel: Channel) -> dict[str, Callable[[Any], None]]:
    """Return what can go wrong with the messages of a channel; each changes one in place."""
    observed = channel.observed[0]
    found: dict[str, Callable[[Any], None]] = {}
    if observed.kind != 'switch':
        found['nan'] = _changed(observed.path, lambda values: np.append(np.nan, values[1:]))
    if channel.has_joints:
        found |= {'wrong_length': _wrong_length, 'wrong_names': _wrong_names}
    elif channel.frames:
        found['wrong_frame'] = lambda message: setattr(message.header, 'frame_id', 'wrong_frame')
    if observed.kind == 'quaternion':
        found['bad_quaternion'] = _changed(observed.path, lambda values: 1.2 * values)
    if _ACCELERATION in (field.path for field in channel.fields):
        found['flipped_gravity'] = _changed(_ACCELERATION, lambda values: -values)
    # A wrong unit shows where it makes what is observed large, or gravity small.
    known = [field for field in channel.fields if field.unit in OTHER_UNITS and field.unit != '1']
    measured = next((each for each in known if each.scale or each.path == _ACCELERATION), None)
    if measured is not None:
        factors = [factor for _, factor in OTHER_UNITS[measured.unit]]
        factor = max(factors) if measured.scale else min(factors)
        found['wrong_unit'] = _changed(measured.path, lambda values: factor * values)
    return found


def fault_names(channel: Channel) -> tuple[str, ...]:
    """Return the names of all faults that a channel's driver can have."""
    return (STOPPED, STALE_STAMPS, *faults(channel))


def _changed(path: str, change: Callable[[Any], Any]) -> Callable[[Any], None]:
    return lambda message: write(message, path, change(read(message, path)))


def _wrong_length(message: Any) -> None:
    for field in _JOINT_FIELDS:
        setattr(message, field, getattr(message, field)[:-1])


def _wrong_names(message: Any) -> None:
    message.name = [f'joint_{index}' for index in range(len(message.name))]


def _joint_order(row: Channel, settings: Mapping[str, Any]) -> list[int] | None:
    """Return the index of our joint at each place of the device, -1 for a joint that is not ours.

    Raises:
        ValueError: The channel has no joints, or the order no place for further ones.
    """
    order, extra = settings['joint_order'], settings['extra_joints']
    if not row.has_joints:
        if order != OUR_ORDER or settings['joint_prefix'] or extra:
            raise ValueError(f'joint_*: expected a channel with joints, not {row.device_topic}')
        return None
    if extra and order != SHUFFLED:
        raise ValueError(f'extra_joints {extra}: expected joint_order {SHUFFLED}')
    places = [*range(len(JOINTS)), *[-1] * extra]
    if order == SHUFFLED:
        np.random.default_rng(settings['seed']).shuffle(places)
    return places[::-1] if order == REVERSED else places


def _reorder_joints(message: Any, order: list[int], prefix: str) -> None:
    """Put names and numbers of a joint message in a device's order."""
    names, extra = message.name, iter(range(len(order)))
    message.name = [f'{prefix}{names[i]}' if i >= 0 else f'extra_{next(extra)}' for i in order]
    for field in _JOINT_FIELDS:
        values = getattr(message, field)
        if len(values):
            setattr(message, field, array('d', [values[i] if i >= 0 else 0.0 for i in order]))
