# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Legs that are not there."""

from dataclasses import dataclass

import mujoco

from hexapod_sim.variations.legs import LegNames, LegVariation
from hexapod_sim.variations.variation import geoms_of, joints_of, paint, weaken

# MuJoCo wants a mass of every moving body; 0.2 mg move nothing.
_LEFT_OVER = 1e-6


@dataclass(frozen=True)
class MissingLegsOptions:
    """Options of missing legs."""

    missing_legs: LegNames
    """Missing legs: which, with + between them, or none; their joints' angles stand still."""


class MissingLegs(LegVariation):
    """Legs without weight, torque, contact and look.

    The joint vectors keep their 18 places: what stands for a missing leg in them keeps its angles,
    as the gears' inertia is left.
    """

    def __init__(self, options: MissingLegsOptions) -> None:
        """Take the legs."""
        super().__init__(options.missing_legs)

    def apply(self, spec: mujoco.MjSpec) -> None:
        """Take weight, torque and look."""
        weaken(spec, joints_of(self.legs), 0.0)
        for leg in self.legs:
            for geom in geoms_of(spec, leg):
                geom.mass *= _LEFT_OVER
                paint(geom, (0.0, 0.0, 0.0, 0.0))

    def finish(self, model: mujoco.MjModel) -> None:
        """Let their feet touch nothing; the search for contacts keeps its places for them."""
        for leg in self.legs:
            foot = model.geom(f'{leg}_foot')
            foot.contype[0] = 0
            model.body_contype[foot.bodyid[0]] = 0
