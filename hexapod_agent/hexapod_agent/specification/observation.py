# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What an agent observes: the vector that is made of a chosen set of the sensor table."""

from collections.abc import Mapping

import numpy as np
from hexapod_sim.channel import Channel
from hexapod_sim.sensor_table import CHANNELS, LETTERS, PREVIOUS_ACTION
from numpy.typing import NDArray


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
            for quantity in channel.quantities:
                part = slice(start, start + quantity.size)
                self._slices[quantity.name] = (channel, part)
                self.scale[part] = quantity.scale
                self.center[part] = quantity.center
                start += quantity.size
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
