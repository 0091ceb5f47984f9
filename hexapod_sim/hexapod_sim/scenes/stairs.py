# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Stairs that rise along the walk, of boxes, and end in a landing."""

import math
from dataclasses import dataclass
from typing import Annotated, Any

import mujoco
import numpy as np
from annotated_types import Interval

from hexapod_sim.scenes.scene import LENGTH, CommonOptions, Metres, Scene, add_box

_HALF_WIDTH = 60.0  # m
_LANDING = 60.0  # m


@dataclass(frozen=True)
class StairsOptions:
    """Options of stairs."""

    rise: Annotated[float, Interval(ge=0.0, le=0.2)]
    """Stairs: height of a step [m]."""
    tread: Annotated[float, Interval(ge=0.1, le=2.0)]
    """Stairs: depth of a step [m]."""


@dataclass(frozen=True)
class _Options(CommonOptions, StairsOptions):
    pass


class Stairs(Scene):
    """Steps from the run-up until `LENGTH`; the last one is the landing."""

    def __init__(self, options: _Options) -> None:
        """Count the steps."""
        self._start, self._rise, self._tread = options.run_up, options.rise, options.tread
        self._steps = math.ceil((LENGTH - options.run_up) / options.tread)

    def build(self, spec: mujoco.MjSpec) -> None:
        """Add a box for each step; they stand side by side, and none in another."""
        if not self._rise:
            return
        for step in range(self._steps):
            x = self._start + step * self._tread
            end = x + (self._tread if step + 1 < self._steps else _LANDING)
            top = (step + 1) * self._rise
            add_box(spec, (x, end), (-_HALF_WIDTH, _HALF_WIDTH), top, step % 2)

    def height(self, x: Any, y: Any) -> Metres:
        """Return the tops of the steps."""
        x, _ = np.broadcast_arrays(x, y)
        done = np.floor((x - self._start) / self._tread) + 1
        return np.clip(done, 0, self._steps) * self._rise
