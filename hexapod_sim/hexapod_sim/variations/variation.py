# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What a variation of the robot is: options, and a change of the model.

A variation is one file here. It has

- a frozen dataclass of its options: each field with its range, and a docstring that ends in the
  unit. `variations.table.RobotConfig` inherits all of them, so that `robot.<option>` is a key of
  a run's specification and a parameter of the node `sim`; article.yaml has the value, with which
  the robot is as it was built;
- a subclass of `Variation` that takes them, with an entry in `variations.table.VARIATIONS`.

It may come in the middle of an episode, so it changes numbers of a model only: what takes room in
one is there before, without effect, by `prepare`.
"""

from abc import ABC, abstractmethod
from collections.abc import Iterable
from typing import Any

import mujoco

from hexapod_sim.robot import LEG_JOINTS

NONE = 'none'
"""No leg or joint."""


class Variation(ABC):
    """A change of the robot."""

    @abstractmethod
    def __init__(self, options: Any) -> None:
        """Take the options, of the variation's own type."""

    @property
    @abstractmethod
    def is_present(self) -> bool:
        """Whether the options ask for anything."""

    def prepare(self, spec: mujoco.MjSpec) -> None:  # noqa: B027 (most need none)
        """Add to a model what the change needs room for, without effect."""

    @abstractmethod
    def apply(self, spec: mujoco.MjSpec) -> None:
        """Change a model that is prepared."""

    def finish(self, model: mujoco.MjModel) -> None:  # noqa: B027 (likewise)
        """Change what, in a specification, would give the compiled model another structure."""


def named(text: str, known: Iterable[str]) -> tuple[str, ...]:
    """Return the names in a text such as 'lf+rm'; `none` has none.

    Raises:
        ValueError: One is unknown, or there twice.
    """
    names = () if text == NONE else tuple(text.split('+'))
    if not set(names) <= set(known) or len(set(names)) < len(names):
        raise ValueError(f'{NONE}, or some of {", ".join(known)} with + between them')
    return names


def weaken(spec: mujoco.MjSpec, joints: Iterable[str], strength: float) -> None:
    """Leave servos a share of their torque at every position error, and so of their greatest."""
    for joint in joints:
        servo = spec.actuator(joint)
        servo.gainprm[0] *= strength
        servo.biasprm[1] *= strength
        if strength:
            servo.forcerange[:] *= strength


def joints_of(legs: Iterable[str]) -> list[str]:
    """Return the names of legs' joints."""
    return [f'{leg}_{joint}' for leg in legs for joint in LEG_JOINTS]


def geoms_of(spec: mujoco.MjSpec, leg: str) -> list[mujoco.MjsGeom]:
    """Return the links of a leg, its foot last."""
    return [spec.geom(f'{leg}_{link}') for link in ('coxa', 'femur', 'tibia', 'foot')]


def paint(geom: mujoco.MjsGeom, colour: tuple[float, float, float, float]) -> None:
    """Give a geom a colour instead of its material."""
    geom.material = ''
    geom.rgba[:] = colour
