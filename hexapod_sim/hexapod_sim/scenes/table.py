# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""All scenes by name, and the section `scene` of a specification."""

from dataclasses import dataclass
from typing import Any, Literal

import mujoco

from hexapod_sim.article import section
from hexapod_sim.scenes.flat import Flat
from hexapod_sim.scenes.rough import HALF_WIDTH, Rough, RoughOptions
from hexapod_sim.scenes.scene import CommonOptions, Scene
from hexapod_sim.scenes.slope import Slope, SlopeOptions
from hexapod_sim.scenes.stairs import Stairs, StairsOptions

SCENES: dict[str, type[Scene]] = {'flat': Flat, 'rough': Rough, 'stairs': Stairs, 'slope': Slope}
_BESIDE = 0.4  # m that the legs reach to either side of base_link, and some more


@dataclass(frozen=True)
class SceneConfig(SlopeOptions, StairsOptions, RoughOptions, CommonOptions):
    """The ground and its options; those of other scenes than the named one do nothing."""

    name: Literal['flat', 'rough', 'stairs', 'slope']
    """Which ground."""

    @classmethod
    def of_article(cls, **changes: Any) -> 'SceneConfig':
        """Return the scene of article.yaml, with some values changed."""
        return cls(**section('scene') | changes)

    def make(self) -> Scene:
        """Return the ground."""
        return SCENES[self.name](self)


def add_scene(spec: mujoco.MjSpec, config: SceneConfig) -> Scene:
    """Put a ground into a model, and give all that touches it the friction; return the ground."""
    scene = config.make()
    scene.build(spec)
    for geom in spec.geoms:
        if geom.contype or geom.conaffinity:
            geom.friction[0] = config.friction
    return scene


def check_walk(config: SceneConfig, farthest: float) -> None:
    """Refuse a walk beside the ground.

    Args:
        config: The scene.
        farthest: Greatest |y| of a start or of the line [m].

    Raises:
        ValueError: The robot would not meet what the scene is named for.
    """
    if config.name == 'rough' and farthest > HALF_WIDTH - _BESIDE:
        raise ValueError(
            f'scene.name is rough, whose blocks lie within {HALF_WIDTH} m of y = 0: line and '
            f'start reach {farthest:g} m by task.line_y, line_jump and start_offset, expected at '
            f'most {HALF_WIDTH - _BESIDE:g}'
        )
