# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Readings of the robot's sensors, from MuJoCo's sensor array to the channels of the graph."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from itertools import pairwise
from typing import TYPE_CHECKING

import mujoco
import numpy as np

from hexapod_sim import robot

if TYPE_CHECKING:
    from hexapod_sim.simulation import Simulation

# Sensor names of hexapod.xml behind each block; the model lists a block's sensors in a row.
# Joint torques are the drive's, what AX servos report as present load; back-EMF acts apart.
_BLOCKS = {
    'joint_angles': tuple(f'{joint}_angle' for joint in robot.JOINTS),
    'joint_velocities': tuple(f'{joint}_velocity' for joint in robot.JOINTS),
    'joint_torques': tuple(f'{joint}_torque' for joint in robot.JOINTS),
    'linear_velocity': ('linear_velocity',),
    'orientation': ('orientation',),
    'angular_velocity': ('angular_velocity',),
    'linear_acceleration': ('linear_acceleration',),
    'height': ('height',),
    'feet': tuple(f'{leg}_foot' for leg in robot.LEGS),
}


def locate_blocks(model: mujoco.MjModel) -> dict[str, slice]:
    """Return where each block of sensors lies in ``sensordata``.

    Raises:
        ValueError: The model does not list the sensors of a block in a row.
    """
    blocks = {}
    for block, names in _BLOCKS.items():
        spans = [(int(s.adr[0]), int(s.adr[0] + s.dim[0])) for s in map(model.sensor, names)]
        if any(left[1] != right[0] for left, right in pairwise(spans)):
            raise ValueError(f'sensors of block {block!r}: expected them in a row in the model')
        blocks[block] = slice(spans[0][0], spans[-1][1])
    return blocks


def foot_forces(wrench: np.ndarray) -> np.ndarray:
    """Return normal and friction forces of the feet from their force vectors.

    Args:
        wrench: Force of the floor on each foot (6, 3) [N], z along the floor's normal.

    Returns:
        Six normal forces, then six friction magnitudes (12,) [N].
    """
    return np.concatenate((np.abs(wrench[:, 2]), np.hypot(wrench[:, 0], wrench[:, 1])))


def read(simulation: Simulation, channels: Iterable[str]) -> dict[str, np.ndarray]:
    """Read channels at the end of the last control period, as float64 arrays of their own.

    Args:
        simulation: The robot to read.
        channels: Names out of ``CHANNEL_READERS``.

    Raises:
        ValueError: A channel is not known.
    """
    try:
        return {channel: CHANNEL_READERS[channel](simulation) for channel in channels}
    except KeyError as error:
        raise ValueError(
            f'sensor channel {error.args[0]!r}: expected one of {", ".join(CHANNEL_READERS)}'
        ) from None


def _block_reader(block: str) -> Callable[[Simulation], np.ndarray]:
    """Return a reader that copies one block unchanged."""

    def read_block(simulation: Simulation) -> np.ndarray:
        return simulation.data.sensordata[simulation.sensor_blocks[block]].copy()

    return read_block


def _read_orientation(simulation: Simulation) -> np.ndarray:
    """Orientation of imu_link in odom, MuJoCo's w x y z turned into x y z w."""
    w, x, y, z = simulation.data.sensordata[simulation.sensor_blocks['orientation']].tolist()
    return np.array((x, y, z, w))


def _read_height(simulation: Simulation) -> np.ndarray:
    """Distance to the floor along the body's downward axis [m], rounded as the message has it.

    MuJoCo gives -1 where the ray meets nothing: the device then reports the end of its range.
    sensor_msgs/Range carries float32, so every path sees the number rounded to it.
    """
    distance = float(simulation.data.sensordata[simulation.sensor_blocks['height'].start])
    if not 0.0 <= distance <= robot.HEIGHT_RANGE_MAX:
        distance = robot.HEIGHT_RANGE_MAX
    return np.array((np.float32(distance),), dtype=np.float64)


def _feet(simulation: Simulation) -> np.ndarray:
    """View of the feet's sensors (6, 4): found, then the force in axes parallel to odom."""
    return simulation.data.sensordata[simulation.sensor_blocks['feet']].reshape(-1, 4)


def _read_foot_wrench(simulation: Simulation) -> np.ndarray:
    """Force of the floor on each foot (6, 3) [N], axes parallel to odom, z up."""
    return _feet(simulation)[:, 1:].copy()


def _read_foot_forces(simulation: Simulation) -> np.ndarray:
    """Normal and friction forces (12,) [N]."""
    return foot_forces(_feet(simulation)[:, 1:])


def _read_foot_contacts(simulation: Simulation) -> np.ndarray:
    """1 where a foot touches the floor, else 0 (6,)."""
    return _feet(simulation)[:, 0].copy()


CHANNEL_READERS: dict[str, Callable[[Simulation], np.ndarray]] = {
    'joint_angles': _block_reader('joint_angles'),
    'joint_velocities': _block_reader('joint_velocities'),
    'joint_torques': _block_reader('joint_torques'),
    'linear_velocity': _block_reader('linear_velocity'),
    'orientation': _read_orientation,
    'angular_velocity': _block_reader('angular_velocity'),
    'linear_acceleration': _block_reader('linear_acceleration'),
    'height': _read_height,
    'foot_forces': _read_foot_forces,
    'foot_contacts': _read_foot_contacts,
    'foot_wrench': _read_foot_wrench,
}
