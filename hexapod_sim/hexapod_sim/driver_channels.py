# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What the messages of each sensor topic hold, for a driver that republishes them as its own.

Messages are told by their fields alone, so that nothing here needs ROS.
"""

from __future__ import annotations

from array import array
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hexapod_sim.degradation import Kind
from hexapod_sim.robot import LEGS

JOINT_FIELDS = ('position', 'velocity', 'effort')


@dataclass(frozen=True)
class Reading:
    """A field that a device measures."""

    path: str
    kind: Kind = 'vector'


@dataclass(frozen=True)
class DriverChannel:
    """One device: its topics and what it measures."""

    topics: tuple[str, ...]
    """As the sim names them."""
    readings: tuple[Reading, ...]
    """The ones that are degraded; the second one has parameters of its own."""

    @property
    def has_joints(self) -> bool:
        """Whether the numbers stand under joint names."""
        return self.readings[0].path in JOINT_FIELDS


CHANNELS: dict[str, DriverChannel] = {
    'joint_states': DriverChannel(('joint_states',), (Reading('position'), Reading('velocity'))),
    'line_offset': DriverChannel(('line_offset',), (Reading('offset'),)),
    'joint_torques': DriverChannel(('joint_torques',), (Reading('effort'),)),
    'body/twist': DriverChannel(('body/twist',), (Reading('twist.linear'),)),
    'imu/data': DriverChannel(('imu/data',), (Reading('orientation', 'quaternion'),)),
    'imu/data_raw': DriverChannel(('imu/data_raw',), (Reading('angular_velocity'),)),
    'body/height': DriverChannel(('body/height',), (Reading('range'),)),
    'foot_force': DriverChannel(
        tuple(f'foot_force/{leg}' for leg in LEGS), (Reading('wrench.force'),)
    ),
    'foot_contacts': DriverChannel(('foot_contacts',), (Reading('contact', 'switch'),)),
}


def read(message: Any, path: str) -> NDArray[np.float64]:
    """Return the numbers of a field: a scalar, an array, x y z, or x y z w."""
    owner, name = _locate(message, path)
    value = getattr(owner, name)
    if hasattr(value, 'x'):
        value = [getattr(value, axis) for axis in _axes(value)]
    return np.atleast_1d(np.asarray(value, dtype=np.float64))


def write(message: Any, path: str, values: NDArray[np.float64]) -> None:
    """Write the numbers of a field in the type that it has."""
    owner, name = _locate(message, path)
    had = getattr(owner, name)
    if hasattr(had, 'x'):
        for axis, value in zip(_axes(had), values.tolist(), strict=True):
            setattr(had, axis, value)
    elif isinstance(had, float):
        setattr(owner, name, float(values[0]))
    elif isinstance(had, array):
        setattr(owner, name, array('d', values.tolist()))
    else:
        setattr(owner, name, (values > 0.5).tolist())


@dataclass(frozen=True)
class JointLayout:
    """A driver's own order and names of the joints."""

    order: Sequence[int]
    """Index of our joint at each place; -1 for a joint that is not ours."""
    prefix: str = ''

    @classmethod
    def shuffled(cls, joints: int, extra: int, prefix: str, seed: int) -> JointLayout:
        """Return an order drawn from the seed, with further joints between ours."""
        order = [*range(joints), *[-1] * extra]
        np.random.default_rng(seed).shuffle(order)
        return cls(order, prefix)

    def apply(self, message: Any) -> None:
        """Put names and numbers of a joint message in this order."""
        names, extra = message.name, iter(range(len(self.order)))
        message.name = [
            f'{self.prefix}{names[index]}' if index >= 0 else f'extra_{next(extra)}'
            for index in self.order
        ]
        for field in JOINT_FIELDS:
            values = getattr(message, field)
            if len(values):
                placed = [values[index] if index >= 0 else 0.0 for index in self.order]
                setattr(message, field, array('d', placed))


def _locate(message: Any, path: str) -> tuple[Any, str]:
    *owners, name = path.split('.')
    for owner in owners:
        message = getattr(message, owner)
    return message, name


def _axes(value: Any) -> str:
    return 'xyzw' if hasattr(value, 'w') else 'xyz'
