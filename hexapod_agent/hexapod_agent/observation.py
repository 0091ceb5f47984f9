# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The sensor table: every channel that an agent can observe, and the vector made of a chosen set.

Subscriptions, input sizes, factors of the experiment and report labels all read this table.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from hexapod_cpg.mapping import ACTION_SIZE
from hexapod_sim.robot import (
    BASE_FRAME,
    FOOT_FRAMES,
    GRAVITY,
    HEIGHT_FRAME,
    HEIGHT_RANGE_MAX,
    IMU_FRAME,
    LEGS,
    NO_LOAD_SPEED,
    ODOM_FRAME,
    TORQUE_LIMIT,
    TOTAL_MASS,
)
from numpy.typing import NDArray

PREVIOUS_ACTION = 'previous_action'


@dataclass(frozen=True)
class Channel:
    """One row of the sensor table.

    A number x is observed as clip((x - center) / scale, -1, 1).

    Attributes:
        letter: Factor of the experiment; empty for a channel that is always observed.
        name: What the channel measures, as reports print it.
        topics: Relative topic names that carry it; empty if nothing has to be subscribed to.
        message_type: ROS type of those topics.
        readings: Keys of its values in a mapping of readings, in the order of the observation.
        sizes: Count of numbers of each reading.
        units: Unit of each reading.
        scales: Deviation from the center that is observed as 1, for each reading, in its unit.
        device: What yields it on a physical robot.
        centers: Value that is observed as 0, for each reading, in its unit; empty for zeros.
        limits: Largest magnitude that a working device gives in walking, for each reading, in its
            unit; what lies beyond is in another unit. Infinite where the norm tells, and empty if
            nothing measures the channel.
        frames: Frame of each topic; empty if its values have no axes, as joint angles.
    """

    letter: str
    name: str
    topics: tuple[str, ...]
    message_type: str
    readings: tuple[str, ...]
    sizes: tuple[int, ...]
    units: tuple[str, ...]
    scales: tuple[float, ...]
    device: str
    centers: tuple[float, ...] = ()
    limits: tuple[float, ...] = ()
    frames: tuple[str, ...] = ()

    @property
    def size(self) -> int:
        """Count of numbers that the channel adds to the observation."""
        return sum(self.sizes)

    @property
    def unit(self) -> str:
        """Units of the readings, for tables."""
        return ', '.join(self.units)

    @property
    def scale(self) -> str:
        """Scales of the readings, for tables."""
        return ', '.join(f'{scale:g}' for scale in self.scales)


CHANNELS = (
    Channel(
        '', 'joint angles and velocities', ('joint_states',), 'sensor_msgs/msg/JointState',
        ('joint_angles', 'joint_velocities'), (18, 18), ('rad', 'rad/s'), (1.0, NO_LOAD_SPEED),
        'joint encoders', limits=(math.pi / 2, 2 * NO_LOAD_SPEED),
    ),
    Channel(
        '', 'oscillator state', ('cpg/state',), 'hexapod_interfaces/msg/CpgState',
        ('oscillator',), (12,), ('1',), (1.2,), 'none (computed)', limits=(2.0,),
    ),
    Channel(
        '', 'previous action', (), '', (PREVIOUS_ACTION,), (ACTION_SIZE,), ('1',), (1.0,), 'none',
    ),
    Channel(
        '', 'line offset', ('line_offset',), 'hexapod_interfaces/msg/LineOffset',
        ('line_offset',), (1,), ('m',), (1.0,), 'line sensor or localisation',
        limits=(10.0,), frames=(ODOM_FRAME,),
    ),
    Channel(
        'A', 'joint torques', ('joint_torques',), 'sensor_msgs/msg/JointState',
        ('joint_torques',), (18,), ('N·m',), (TORQUE_LIMIT,), '18 current sensors',
        limits=(2 * TORQUE_LIMIT,),
    ),
    Channel(
        'B', 'body linear velocity', ('body/twist',), 'geometry_msgs/msg/TwistStamped',
        ('linear_velocity',), (3,), ('m/s',), (0.5,), 'estimator or optical flow',
        limits=(2.0,), frames=(BASE_FRAME,),
    ),
    Channel(
        'C', 'body orientation', ('imu/data',), 'sensor_msgs/msg/Imu',
        ('orientation',), (4,), ('1',), (1.0,), 'IMU with fusion',
        limits=(math.inf,), frames=(IMU_FRAME,),
    ),
    Channel(
        'D', 'body angular velocity', ('imu/data_raw',), 'sensor_msgs/msg/Imu',
        ('angular_velocity',), (3,), ('rad/s',), (2.0,), 'IMU',
        limits=(8.0,), frames=(IMU_FRAME,),
    ),
    Channel(
        'E', 'body height', ('body/height',), 'sensor_msgs/msg/Range',
        ('height',), (1,), ('m',), (0.05,), 'range finder', (0.13,),
        limits=(HEIGHT_RANGE_MAX,), frames=(HEIGHT_FRAME,),
    ),
    Channel(
        'F', 'foot forces', tuple(f'foot_force/{leg}' for leg in LEGS),
        'geometry_msgs/msg/WrenchStamped', ('foot_forces',), (12,), ('N',), (20.0,),
        'six load cells', limits=(8 * TOTAL_MASS * GRAVITY,), frames=FOOT_FRAMES,
    ),
    Channel(
        'G', 'foot contacts', ('foot_contacts',), 'hexapod_interfaces/msg/FootContacts',
        ('foot_contacts',), (6,), ('1',), (1.0,), 'six switches', limits=(1.0,),
    ),
)  # fmt: skip
LETTERS = ''.join(channel.letter for channel in CHANNELS)


class ObservationError(ValueError):
    """A reading cannot be observed; the message names its channel."""


def parse_observations(text: str) -> str:
    """Bring a set of optional channels to its one spelling, sorted and without repeats.

    Raises:
        ValueError: A letter names no channel.
    """
    for letter in text:
        if letter not in LETTERS:
            raise ValueError(
                f'observations {text!r}: unknown letter {letter!r}, expected letters of {LETTERS}'
            )
    return ''.join(sorted(set(text)))


class ObservationSpec:
    """What an agent with a given set of optional channels observes, and in which order.

    Attributes:
        letters: The set's sorted letters.
        channels: Its channels, the ones that are always observed first.
        topics: Topics to subscribe to, relative, in the order of the channels.
        names: Names of the channels.
        readings: Keys that `assemble` looks up.
        sizes: Count of numbers of each part, readings and previous action, in their order.
        size: Count of numbers.
        center: Value observed as 0, for each number, in its unit (size,).
        scale: Deviation from it observed as 1, for each number (size,).
    """

    def __init__(self, observations: str) -> None:
        self.letters = parse_observations(observations)
        self.channels = tuple(c for c in CHANNELS if not c.letter or c.letter in self.letters)
        self.topics = tuple(topic for channel in self.channels for topic in channel.topics)
        self.names = tuple(channel.name for channel in self.channels)
        self.size = sum(channel.size for channel in self.channels)
        self._slices: dict[str, tuple[Channel, slice]] = {}
        self.center = np.empty(self.size)
        self.scale = np.empty(self.size)
        start = 0
        for channel in self.channels:
            centers = channel.centers or (0.0,) * len(channel.readings)
            columns = (channel.sizes, channel.scales, centers)
            for key, size, scale, center in zip(channel.readings, *columns, strict=True):
                part = slice(start, start + size)
                self._slices[key] = (channel, part)
                self.scale[part] = scale
                self.center[part] = center
                start += size
        self.readings = tuple(key for key in self._slices if key != PREVIOUS_ACTION)
        self.sizes = {key: part.stop - part.start for key, (_, part) in self._slices.items()}

    def assemble(
        self, readings: Mapping[str, NDArray[np.floating]], previous_action: NDArray[np.floating]
    ) -> NDArray[np.float32]:
        """Normalise the readings of one instant into the observation vector.

        Args:
            readings: Values by key, in the units of the table; further keys are not looked at.
            previous_action: Action (30,) of the control period that just ended, within +-1.

        Returns:
            Vector (size,) within +-1.

        Raises:
            ObservationError: A reading is missing, has the wrong length, or is not finite.
        """
        vector = np.empty(self.size)
        for key, (channel, part) in self._slices.items():
            value = previous_action if key == PREVIOUS_ACTION else readings.get(key)
            if value is None or value.size != part.stop - part.start:
                raise _wrong_size(channel, key, part, value)
            vector[part] = value
        if not np.isfinite(vector).all():
            index = int(np.flatnonzero(~np.isfinite(vector))[0])
            raise ObservationError(
                f'{self.locate(index)} is {vector[index]}, expected a finite number'
            )
        vector -= self.center
        vector /= self.scale
        return vector.clip(-1.0, 1.0).astype(np.float32)

    def locate(self, index: int) -> str:
        """Name the channel, and the reading in it, of a number of the vector."""
        for key, (channel, part) in self._slices.items():
            if part.start <= index < part.stop:
                return f'channel {channel.name!r}: {key}[{index - part.start}]'
        raise IndexError(f'index {index}, expected one below {self.size}')


def _wrong_size(
    channel: Channel, key: str, part: slice, value: NDArray[np.floating] | None
) -> ObservationError:
    """Name a reading that is missing or has another length than the table says."""
    found = 'nothing' if value is None else f'{value.size} numbers'
    return ObservationError(
        f'channel {channel.name!r}: {key} has {found}, expected {part.stop - part.start} numbers'
    )
