# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The floor of hexapod.xml and nothing else."""

from typing import Any

import mujoco
import numpy as np

from hexapod_sim.scenes.scene import CommonOptions, Metres, Scene


class Flat(Scene):
    """A level floor without end."""

    def __init__(self, options: CommonOptions) -> None:
        """Take nothing: it has no options of its own."""

    def build(self, spec: mujoco.MjSpec) -> None:
        """Add nothing."""

    def height(self, x: Any, y: Any) -> Metres:
        """Return zeros."""
        return np.zeros(np.broadcast_shapes(np.shape(x), np.shape(y)))
