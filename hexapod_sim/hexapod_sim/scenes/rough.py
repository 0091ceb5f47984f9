# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Rough ground: square blocks side by side, each of a random height.

Blocks and no height field: MuJoCo keeps 50 contacts of a field and drops the rest, and a field's
cells smaller than a foot misbehave (google-deepmind/mujoco#236, #689). A block is one geom, and
costs 0.05 us in each physics step; half as large ones are four times as many.
"""

from dataclasses import dataclass
from typing import Annotated, Any

import mujoco
import numpy as np
from annotated_types import Interval

from hexapod_sim.scenes.scene import LENGTH, CommonOptions, Metres, Scene, add_box

HALF_WIDTH = 2.4
"""How far it reaches to either side of y = 0 [m]: a robot that strays by 2 m is still on it."""


@dataclass(frozen=True)
class RoughOptions:
    """Options of rough ground."""

    roughness: Annotated[float, Interval(ge=0.0, le=0.1)]
    """Rough: greatest height of a block; heights are uniform from 0 to it [m]."""
    block: Annotated[float, Interval(ge=0.1, le=1.0)]
    """Rough: edge of a block; feet are 0.024 m wide [m]."""
    seed: Annotated[int, Interval(ge=0, le=2**31 - 1)]
    """Rough: seed of the heights."""


@dataclass(frozen=True)
class _Options(CommonOptions, RoughOptions):
    pass


class Rough(Scene):
    """Blocks from the run-up to `LENGTH`, and to `HALF_WIDTH` on either side of y = 0."""

    def __init__(self, options: _Options) -> None:
        """Draw the heights; without roughness there is no block."""
        self._block, self._start = options.block, options.run_up
        self._greatest = options.roughness
        columns = int(np.ceil((LENGTH - options.run_up) / options.block))
        self._half_rows = int(np.ceil(HALF_WIDTH / options.block))
        generator = np.random.default_rng(options.seed)
        self._heights = generator.uniform(0.0, self._greatest, (columns, 2 * self._half_rows))

    def build(self, spec: mujoco.MjSpec) -> None:
        """Add the blocks."""
        if not self._greatest:
            return
        for (column, row), top in np.ndenumerate(self._heights):
            x, y = self._start + column * self._block, (row - self._half_rows) * self._block
            ends = (x, x + self._block), (y, y + self._block)
            add_box(spec, *ends, float(top), float(top) / self._greatest)

    def height(self, x: Any, y: Any) -> Metres:
        """Return the tops of the blocks, zero beside them."""
        columns, rows = self._heights.shape
        column = np.floor((np.asarray(x) - self._start) / self._block)
        row = np.floor(np.asarray(y) / self._block) + self._half_rows
        inside = (column >= 0) & (column < columns) & (row >= 0) & (row < rows)
        place = np.where(inside, column, 0).astype(int), np.where(inside, row, 0).astype(int)
        return np.where(inside, self._heights[place], 0.0)
