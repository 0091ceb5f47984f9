# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Legs whose servos give no torque."""

from dataclasses import dataclass

import mujoco

from hexapod_sim.variations.legs import LegNames, LegVariation
from hexapod_sim.variations.variation import geoms_of, joints_of, paint, weaken

COLOUR = (0.75, 0.16, 0.14, 1.0)


@dataclass(frozen=True)
class DeadLegsOptions:
    """Options of dead legs."""

    dead_legs: LegNames
    """Dead legs: which, with + between them, or none; no torque, and the drag of the gears."""


class DeadLegs(LegVariation):
    """Limp legs: the gears' inertia and drag stay, and so do encoders and contacts."""

    def __init__(self, options: DeadLegsOptions) -> None:
        """Take the legs."""
        super().__init__(options.dead_legs)

    def apply(self, spec: mujoco.MjSpec) -> None:
        """Take the torque of their servos, and paint them."""
        weaken(spec, joints_of(self.legs), 0.0)
        for leg in self.legs:
            for geom in geoms_of(spec, leg):
                paint(geom, COLOUR)
