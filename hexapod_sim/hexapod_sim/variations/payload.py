# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A load that is fixed to the body."""

from dataclasses import dataclass
from typing import Annotated

import mujoco
from annotated_types import Interval

from hexapod_sim.robot import BASE_FRAME
from hexapod_sim.variations.variation import Variation, paint

_Place = Annotated[float, Interval(ge=-0.5, le=0.5)]
COLOUR = (0.20, 0.42, 0.75, 1.0)


@dataclass(frozen=True)
class PayloadOptions:
    """Options of a payload."""

    payload: Annotated[float, Interval(ge=0.0, le=10.0)]
    """Payload: mass of a cube of even density; 0 for none [kg]."""
    payload_x: _Place
    """Payload: its centre ahead of base_link [m]."""
    payload_y: _Place
    """Payload: its centre to the left of base_link [m]."""
    payload_z: _Place
    """Payload: its centre above base_link; the deck is at 0.034 [m]."""
    payload_edge: Annotated[float, Interval(ge=0.01, le=0.5)]
    """Payload: edge of the cube, whose inertia is mass times edge squared over 6 [m]."""


class Payload(Variation):
    """A cube on the body, with its mass and inertia; it touches nothing."""

    def __init__(self, options: PayloadOptions) -> None:
        """Take mass, place and size."""
        self._mass = options.payload
        self._place = options.payload_x, options.payload_y, options.payload_z
        self._edge = options.payload_edge

    @property
    def is_present(self) -> bool:
        """Whether it has a mass."""
        return bool(self._mass)

    def prepare(self, spec: mujoco.MjSpec) -> None:
        """Add a cube that neither weighs anything nor is seen."""
        spec.body(BASE_FRAME).add_geom(
            name='payload',
            type=mujoco.mjtGeom.mjGEOM_BOX,
            pos=self._place,
            size=[self._edge / 2] * 3,
            mass=0.0,
            rgba=[0.0] * 4,
            contype=0,
            conaffinity=0,
            group=1,
        )

    def apply(self, spec: mujoco.MjSpec) -> None:
        """Give it its mass and a colour."""
        geom = spec.geom('payload')
        geom.mass = self._mass
        paint(geom, COLOUR)
