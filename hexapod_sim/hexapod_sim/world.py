# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What physics is made of: hexapod.xml on the ground of a scene."""

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import mujoco

from hexapod_sim.scenes.scene import Scene
from hexapod_sim.scenes.table import SceneConfig, add_scene

_MODEL_PATH = Path(__file__).with_name('hexapod.xml')


@dataclass(frozen=True)
class World:
    """What a simulation is built of; equal ones behave alike to the last bit."""

    scene: SceneConfig
    """The ground."""

    @classmethod
    @lru_cache(maxsize=1)
    def of_article(cls) -> 'World':
        """Return the world of article.yaml."""
        return cls(SceneConfig.of_article())

    def build(self) -> tuple[mujoco.MjModel, Scene]:
        """Return a compiled model of its own, and its ground."""
        spec = mujoco.MjSpec.from_file(str(_MODEL_PATH))
        scene = add_scene(spec, self.scene)
        return spec.compile(), scene
