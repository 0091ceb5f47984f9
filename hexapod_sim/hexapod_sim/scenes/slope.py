# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A slope that rises along the walk without end."""

import math
from dataclasses import dataclass
from typing import Annotated, Any

import mujoco
import numpy as np
from annotated_types import Interval

from hexapod_sim.scenes.scene import CommonOptions, Metres, Scene, add_ground


@dataclass(frozen=True)
class SlopeOptions:
    """Options of a slope."""

    gradient: Annotated[float, Interval(ge=0.0, le=0.6)]
    """Slope: rise over run; 0.4 are 22 degrees [1]."""


@dataclass(frozen=True)
class _Options(CommonOptions, SlopeOptions):
    pass


class Slope(Scene):
    """A second, tilted plane that comes out of the floor at the end of the run-up."""

    def __init__(self, options: _Options) -> None:
        """Take start and gradient."""
        self._start, self._gradient = options.run_up, options.gradient

    def build(self, spec: mujoco.MjSpec) -> None:
        """Add the plane."""
        if not self._gradient:
            return
        angle = math.atan(self._gradient)
        add_ground(
            spec,
            type=mujoco.mjtGeom.mjGEOM_PLANE,
            pos=[self._start, 0.0, 0.0],
            quat=[math.cos(angle / 2), 0.0, -math.sin(angle / 2), 0.0],
            size=[0.0, 0.0, 0.5],
            material='floor',
        )

    def height(self, x: Any, y: Any) -> Metres:
        """Return the height of the plane, zero before it."""
        x, _ = np.broadcast_arrays(x, y)
        return np.maximum(x - self._start, 0.0) * self._gradient
