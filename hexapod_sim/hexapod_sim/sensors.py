# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Readings of the robot's sensors, from MuJoCo's sensor array to what their devices deliver."""

from collections.abc import Iterable, Sequence
from typing import Protocol

import numpy as np

from hexapod_sim.channel import Channel, Field, Numbers
from hexapod_sim.degradation import Degradation
from hexapod_sim.quality import Qualities
from hexapod_sim.robot import CONTROL_PERIOD_NS
from hexapod_sim.sensor_table import MEASURED, SENSORS
from hexapod_sim.simulation import Simulation


def read(simulation: Simulation, readings: Iterable[str]) -> dict[str, Numbers]:
    """Return readings at the end of the last control period, as float64 arrays of their own.

    Args:
        simulation: The robot to read.
        readings: Keys of `MEASURED`.

    Raises:
        ValueError: A reading is not known.
    """
    try:
        return {reading: _read(simulation, reading) for reading in readings}
    except KeyError as error:
        raise ValueError(
            f'sensor reading {error.args[0]!r}: expected one of {", ".join(MEASURED)}'
        ) from None


def _read(simulation: Simulation, reading: str) -> Numbers:
    """Copy a field's part of the sensor array and convert it."""
    field = MEASURED[reading]
    block: Numbers = simulation.sensordata[simulation.sensor_blocks[reading]]
    return field.carried(block.copy() if field.convert is None else field.convert(block))


class Measurable(Protocol):
    """What the devices measure: a robot, and where it is."""

    simulation: Simulation

    @property
    def line_offset(self) -> float:
        """Distance from the line [m]."""


class Sensors:
    """The devices of a robot: what they deliver in each control period, whoever listens.

    A perfect device delivers the truth of now. Any other has its sample in every period as well:
    where one is late, lost or left out, the newest that arrived stands in.

    Attributes:
        qualities: How good the devices are; a change counts from the next episode.
    """

    def __init__(self, measured: Measurable, qualities: Qualities | None = None) -> None:
        self.qualities = qualities or {}
        self._measured = measured
        self._devices: dict[str, list[Degradation]] = {}
        self._time_ns = 0

    def begin(self, seed: int) -> None:
        """Begin an episode, whose seed is that of all errors, and take its first sample."""
        self._time_ns = -CONTROL_PERIOD_NS
        self._devices = {
            key: [Degradation(SENSORS[key], t, quality, seed) for t in SENSORS[key].topics]
            for key, quality in self.qualities.items()
            if not quality.perfect
        }
        self.sample()

    def sample(self) -> None:
        """Let the devices measure at the end of a control period."""
        self._time_ns += CONTROL_PERIOD_NS
        for key, devices in self._devices.items():
            truth = self._true(SENSORS[key].fields)
            for index, device in enumerate(devices):
                rows = {name: row[index] for name, row in truth.items()}
                device.sample(self._time_ns, truth if len(devices) == 1 else rows)

    def read(self, channel: Channel, fields: Sequence[Field] = ()) -> dict[str, Numbers]:
        """Return what a channel's devices deliver now, by reading.

        Args:
            channel: Which one.
            fields: What is needed of it; all by default.
        """
        devices = self._devices.get(channel.key)
        if devices is None:
            return self._true(fields or channel.fields)
        if len(devices) == 1:
            return dict(devices[0].newest)
        return {name: np.array([d.newest[name] for d in devices]) for name in devices[0].newest}

    def observe(self, channels: Iterable[Channel]) -> dict[str, Numbers]:
        """Return what an agent observes of those channels that devices measure, by quantity."""
        observed: dict[str, Numbers] = {}
        for channel in channels:
            if channel.is_measured:
                observed |= channel.observe(self.read(channel, channel.observed))
        return observed

    def _true(self, fields: Sequence[Field]) -> dict[str, Numbers]:
        """Return what perfect devices read now."""
        if fields[0].reading in MEASURED:
            return read(self._measured.simulation, [field.reading for field in fields])
        return {'line_offset': np.array([self._measured.line_offset])}
