# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""From actions to commands of the pattern generator, and from oscillators to joint angles.

    hip   = hip0 + s k_h x            s makes +x forwards on both sides
    knee  = knee0 + b_k - k_k y       y < 0 is swing: the leg lifts
    ankle = ankle0 + b_a - k_a y

The article leaves open which five numbers per leg the agent sets. Reading D1 takes (k_h, k_k,
b_k, k_a, b_a); reading D2 takes (mu, omega, k_h, k_k, k_a) and leaves the biases at zero.
"""

from dataclasses import dataclass, fields
from functools import lru_cache
from types import MappingProxyType
from typing import Any

import numpy as np
from hexapod_sim.article import section

from hexapod_sim import robot

_LEGS = len(robot.LEGS)
_NEUTRAL = robot.NEUTRAL_POSE.reshape(_LEGS, 3)

# Command fields that the five actions of a leg set, in order.
READINGS = MappingProxyType(
    {
        'D1': ('hip_gain', 'knee_gain', 'knee_bias', 'ankle_gain', 'ankle_bias'),
        'D2': ('mu', 'frequency', 'hip_gain', 'knee_gain', 'ankle_gain'),
    }
)
ACTIONS_PER_LEG = 5
ACTION_SIZE = _LEGS * ACTIONS_PER_LEG


@dataclass(frozen=True, slots=True)
class Command:
    """What the pattern generator is told for one control period; arrays (..., 6), one per leg."""

    mu: np.ndarray
    """Squared radius of the limit cycle [1]."""
    frequency: np.ndarray
    """Angular frequency of the oscillator [rad/s]."""
    hip_gain: np.ndarray
    """Hip angle per unit of x [rad]."""
    knee_gain: np.ndarray
    """Knee angle per unit of -y [rad]."""
    knee_bias: np.ndarray
    """[rad]"""
    ankle_gain: np.ndarray
    """Ankle angle per unit of -y [rad]."""
    ankle_bias: np.ndarray
    """[rad]"""


COMMAND_FIELDS = tuple(field.name for field in fields(Command))


@dataclass(frozen=True)
class ActionRanges:
    """Value at action zero and half width at action one, for each field of a command.

    These ranges cannot topple the robot; wider ones end most early episodes in a fall or a spin.
    Action zero is a straight tripod walk.

    Attributes:
        mu: Of the squared radius of the limit cycle; reading D2 alone sets it.
        frequency: Of the oscillator's angular frequency; reading D2 alone sets it.
        hip_gain: Of the hip angle per unit of x.
        knee_gain: Of the knee angle per unit of -y.
        knee_bias: Of the knee angle's constant part.
        ankle_gain: Of the ankle angle per unit of -y.
        ankle_bias: Of the ankle angle's constant part.
    """

    mu: tuple[float, float]
    frequency: tuple[float, float]
    hip_gain: tuple[float, float]
    knee_gain: tuple[float, float]
    knee_bias: tuple[float, float]
    ankle_gain: tuple[float, float]
    ankle_bias: tuple[float, float]

    @classmethod
    def of_article(cls, **changes: Any) -> 'ActionRanges':
        """Return the ranges of article.yaml, with some values changed."""
        return cls(**section('cpg', 'ranges') | changes)


def command_from_action(action: np.ndarray, reading: str, ranges: ActionRanges) -> Command:
    """Turn the network's action into a command.

    Args:
        action: Leg-major actions (..., 30), each in [-1, 1]; widened to float64 first.
        reading: Key of ``READINGS``.
        ranges: Centre and half width of each field.

    Raises:
        ValueError: The reading is unknown or the action has another size.
    """
    if reading not in READINGS:
        raise ValueError(f'action reading {reading!r}: expected one of {", ".join(READINGS)}')
    action = np.asarray(action, dtype=np.float64)
    if action.shape[-1:] != (ACTION_SIZE,):
        raise ValueError(f'action: expected shape (..., {ACTION_SIZE}), got {action.shape}')
    shape = action.shape[:-1]
    centres, half_widths, constants = _columns(reading, ranges)
    values = centres + half_widths * action.reshape(*shape, _LEGS, ACTIONS_PER_LEG)
    fields = {name: values[..., index] for index, name in enumerate(READINGS[reading])}
    for name, centre in constants.items():
        fields[name] = np.full((*shape, _LEGS), centre)
    return Command(**fields)


@lru_cache(maxsize=16)
def _columns(
    reading: str, ranges: ActionRanges
) -> tuple[np.ndarray, np.ndarray, dict[str, float]]:
    """Return centre and half width of a leg's actions (5,), and the centre of other fields."""
    centres, half_widths = np.array([getattr(ranges, name) for name in READINGS[reading]]).T
    others = [name for name in COMMAND_FIELDS if name not in READINGS[reading]]
    return centres, half_widths, {name: getattr(ranges, name)[0] for name in others}


def action_from_command(command: Command, reading: str, ranges: ActionRanges) -> np.ndarray:
    """Return the action (..., 30), float32, that a command was made of.

    The inverse of `command_from_action`, up to the rounding of both; where a field has no width,
    zero. Arguments as there.
    """
    columns = []
    for name in READINGS[reading]:
        centre, half_width = getattr(ranges, name)
        deviation = getattr(command, name) - centre
        columns.append(deviation / half_width if half_width else np.zeros_like(deviation))
    action = np.stack(columns, axis=-1)
    return action.reshape(*action.shape[:-2], ACTION_SIZE).astype(np.float32)


def joint_targets(command: Command, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Return the joint angles (..., 18) [rad] of oscillator states x and y, each (..., 6)."""
    targets = np.empty((*x.shape, 3))
    targets[..., 0] = _NEUTRAL[:, 0] + robot.HIP_FORWARD_SIGN * command.hip_gain * x
    targets[..., 1] = _NEUTRAL[:, 1] + command.knee_bias - command.knee_gain * y
    targets[..., 2] = _NEUTRAL[:, 2] + command.ankle_bias - command.ankle_gain * y
    return targets.reshape(*x.shape[:-1], -1)
