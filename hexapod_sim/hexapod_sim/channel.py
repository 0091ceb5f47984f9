# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What a row of the sensor table says of a channel."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from itertools import groupby
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[np.float64]
Kind = Literal['vector', 'quaternion', 'switch']
"""Numbers that errors are added to, an orientation x y z w that they turn, or on and off."""

JOINT_TYPE = 'sensor_msgs/msg/JointState'


@dataclass(frozen=True)
class Field:
    """One field of a channel's messages.

    Attributes:
        path: In the message, with dots between nested fields.
        reading: Key of its numbers. Fields of one row that share it follow one another there.
        size: Count of numbers in a message.
        unit: Of the numbers.
        scale: Deviation from the center that is observed as 1; 0 for a field that comes along
            but is not observed.
        limit: Largest magnitude that a working device gives in walking; what lies beyond is in
            another unit. Infinite where something else tells.
        center: Value that is observed as 0.
        kind: What the errors of a device do to the numbers.
        model_sensors: Sensors of hexapod.xml that it is read from, of all topics, in a row; by
            default the one that bears the name of the reading.
        convert: Makes the reading (topics * size numbers) of those sensors' numbers.
        single: Whether the message carries float32, to which every path then rounds.
    """

    path: str
    reading: str
    size: int
    unit: str
    scale: float = 0.0
    limit: float = math.inf
    center: float = 0.0
    kind: Kind = 'vector'
    model_sensors: tuple[str, ...] = ()
    convert: Callable[[Numbers], Numbers] | None = None
    single: bool = False

    @property
    def sources(self) -> tuple[str, ...]:
        """Sensors of hexapod.xml that the reading is made of."""
        return self.model_sensors or (self.reading,)

    def carried(self, numbers: Numbers) -> Numbers:
        """Return the numbers that are left of these in a message."""
        return numbers.astype(np.float32).astype(np.float64) if self.single else numbers


@dataclass(frozen=True)
class Quantity:
    """What an agent observes of a channel: numbers that share unit, scale and center."""

    name: str
    size: int
    unit: str
    scale: float
    center: float
    limit: float


@dataclass(frozen=True)
class Derived:
    """A quantity that is computed from a channel's reading where it is observed."""

    name: str
    size: int
    compute: Callable[[Numbers], Numbers]
    """From the reading (topics, size)."""


@dataclass(frozen=True)
class Channel:
    """One row of the sensor table.

    Attributes:
        letter: Factor of the experiment; empty for a channel that is always observed.
        name: What the channel measures, as reports print it.
        topics: Relative topic names that carry it; empty if nothing has to be subscribed to.
        message_type: ROS type of those topics.
        fields: Of its messages, the observed ones in the order of the observation.
        device: What yields it on a physical robot.
        source: Who publishes it where the robot is simulated.
        frames: Frame of each topic; empty if its values have no axes, as joint angles.
        constants: Fields of its messages that never change.
        derived: What is observed in place of the fields' own numbers.
    """

    letter: str
    name: str
    topics: tuple[str, ...]
    message_type: str
    fields: tuple[Field, ...]
    device: str
    source: Literal['robot', 'task', 'cpg', 'agent'] = 'robot'
    frames: tuple[str, ...] = ()
    constants: Mapping[str, Any] = field(default_factory=dict)
    derived: Derived | None = None

    @cached_property
    def key(self) -> str:
        """Name of the channel in a specification, such as 'imu_data'."""
        return self.device_topic.replace('/', '_')

    @property
    def device_topic(self) -> str:
        """Topic of its device; of several topics, what their names have in common."""
        topic = self.topics[0]
        return topic.rsplit('/', 1)[0] if len(self.topics) > 1 else topic

    @cached_property
    def is_measured(self) -> bool:
        """Whether it comes from a device, which the sim or a driver stands for."""
        return self.source in ('robot', 'task')

    @cached_property
    def has_joints(self) -> bool:
        """Whether the numbers stand under joint names."""
        return self.message_type == JOINT_TYPE

    @cached_property
    def observed(self) -> tuple[Field, ...]:
        """The fields that an agent observes."""
        return tuple(each for each in self.fields if each.scale)

    @cached_property
    def quantities(self) -> tuple[Quantity, ...]:
        """What an agent observes, in the order of the observation."""
        found = []
        for reading, group in groupby(self.observed, key=lambda each: each.reading):
            fields = list(group)
            size = sum(each.size for each in fields) * max(len(self.topics), 1)
            name = reading
            if self.derived is not None:
                name, size = self.derived.name, self.derived.size
            first = fields[0]
            found.append(Quantity(name, size, first.unit, first.scale, first.center, first.limit))
        return tuple(found)

    @cached_property
    def readings(self) -> tuple[str, ...]:
        """Names of the quantities."""
        return tuple(quantity.name for quantity in self.quantities)

    @property
    def size(self) -> int:
        """Count of numbers that the channel adds to the observation."""
        return sum(quantity.size for quantity in self.quantities)

    def observe(self, readings: Mapping[str, Numbers]) -> dict[str, Numbers]:
        """Return the quantities by name, from the readings of the fields."""
        if self.derived is not None:
            reading = readings[self.observed[0].reading]
            return {self.derived.name: self.derived.compute(reading)}
        return {name: readings[name] for name in self.readings}
