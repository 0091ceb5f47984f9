# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What physics is made of: hexapod.xml with the robot's variations, on the ground of a scene."""

from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import mujoco

from hexapod_sim.robot import CONTROL_PERIOD_NS
from hexapod_sim.scenes.scene import Scene
from hexapod_sim.scenes.table import SceneConfig, add_scene
from hexapod_sim.variations.fault import Fault
from hexapod_sim.variations.table import RobotConfig

_MODEL_PATH = Path(__file__).with_name('hexapod.xml')


@dataclass(frozen=True)
class World:
    """What a simulation is built of; equal ones behave alike to the last bit."""

    scene: SceneConfig
    """The ground."""
    robot: RobotConfig
    """How the robot varies."""

    @classmethod
    @lru_cache(maxsize=1)
    def of_article(cls) -> 'World':
        """Return the world of article.yaml."""
        return cls(SceneConfig.of_article(), RobotConfig.of_article())

    @property
    def undamaged(self) -> 'World':
        """The same ground with the robot as it was built."""
        return replace(self, robot=self.robot.undamaged)

    @property
    def fault_period(self) -> int:
        """Control periods of an episode before the variations are there; 0 without any."""
        faults = self.robot.fault_time if self.robot.variations else 0.0
        return round(faults * 1e9 / CONTROL_PERIOD_NS)

    def build(self) -> tuple[mujoco.MjModel, Scene, Fault | None]:
        """Compile a model.

        Returns:
            The model as it is when an episode begins, its ground, and what becomes of it later.
        """
        varied, scene = self._compiled(is_varied=True)
        if not self.fault_period:
            return varied, scene, None
        sound, _ = self._compiled(is_varied=False)
        return sound, scene, Fault(sound, varied, self.fault_period)

    def _compiled(self, is_varied: bool) -> tuple[mujoco.MjModel, Scene]:
        spec = mujoco.MjSpec.from_file(str(_MODEL_PATH))
        scene = add_scene(spec, self.scene)
        variations = self.robot.variations
        for variation in variations:
            variation.prepare(spec)
        for variation in variations if is_varied else ():
            variation.apply(spec)
        model = spec.compile()
        for variation in variations if is_varied else ():
            variation.finish(model)
        return model, scene
