# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Legs whose servos give no torque."""

from dataclasses import dataclass
from typing import Annotated

import mujoco
from pydantic import AfterValidator

from hexapod_sim.robot import LEGS
from hexapod_sim.variations.variation import Variation, geoms_of, joints_of, named, paint, weaken

_COLOUR = (0.75, 0.16, 0.14, 1.0)


def check_legs(text: str) -> str:
    """Return a text that names legs.

    Raises:
        ValueError: It does not.
    """
    named(text, LEGS)
    return text


LegNames = Annotated[str, AfterValidator(check_legs)]
"""Legs with + between them, or none."""


@dataclass(frozen=True)
class DeadLegsOptions:
    """Options of dead legs."""

    dead_legs: LegNames
    """Dead legs: which, with + between them, or none; no torque, and the drag of the gears."""


class DeadLegs(Variation):
    """Limp legs: the gears' inertia and drag stay, and so do encoders and contacts."""

    def __init__(self, options: DeadLegsOptions) -> None:
        """Take the legs."""
        self._legs = named(options.dead_legs, LEGS)

    @property
    def is_present(self) -> bool:
        """Whether there is one."""
        return bool(self._legs)

    def apply(self, spec: mujoco.MjSpec) -> None:
        """Take the torque of their servos, and paint them."""
        weaken(spec, joints_of(self._legs), 0.0)
        for leg in self._legs:
            for geom in geoms_of(spec, leg):
                paint(geom, _COLOUR)
