# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Readings of the robot's sensors, from MuJoCo's sensor array to the fields of the table."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

from hexapod_sim.channel import Channel, Field, Numbers
from hexapod_sim.sensor_table import CHANNELS

if TYPE_CHECKING:
    from hexapod_sim.simulation import Simulation

_FIELDS: dict[str, Field] = {
    field.reading: field
    for channel in CHANNELS
    if channel.source == 'robot'
    for field in channel.fields
}
READINGS = tuple(_FIELDS)
"""What can be read from a simulated robot."""
MODEL_SENSORS = {reading: field.model_sensors or (reading,) for reading, field in _FIELDS.items()}
"""Names of the model's sensors that each reading is made of."""


def read(simulation: Simulation, readings: Iterable[str]) -> dict[str, Numbers]:
    """Return readings at the end of the last control period, as float64 arrays of their own.

    Args:
        simulation: The robot to read.
        readings: Names out of `READINGS`.

    Raises:
        ValueError: A reading is not known.
    """
    try:
        return {reading: _READERS[reading](simulation) for reading in readings}
    except KeyError as error:
        raise ValueError(
            f'sensor reading {error.args[0]!r}: expected one of {", ".join(READINGS)}'
        ) from None


def observe(simulation: Simulation, channels: Iterable[Channel]) -> dict[str, Numbers]:
    """Return what an agent observes of those channels that are sensors of the robot, by name."""
    observed: dict[str, Numbers] = {}
    for channel in channels:
        if channel.source == 'robot':
            names = (field.reading for field in channel.observed)
            observed |= channel.observe(read(simulation, names))
    return observed


def _reader(reading: str, field: Field) -> Callable[[Simulation], Numbers]:
    """Return what copies a field's part of the sensor array and converts it."""
    convert = field.convert

    def read_block(simulation: Simulation) -> Numbers:
        block = simulation.data.sensordata[simulation.sensor_blocks[reading]]
        return block.copy() if convert is None else convert(block)

    return read_block


_READERS = {reading: _reader(reading, field) for reading, field in _FIELDS.items()}
