# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What a scene is: options, geoms in the model, and the height of the ground.

A scene is one file here. It has

- a frozen dataclass of its options: each field with its range as an `Interval`, and a docstring
  that ends in the unit. `scenes.table.SceneConfig` inherits all of them, so that `scene.<option>`
  is a key of a run's specification and a parameter of the node `sim`; article.yaml has the value;
- a subclass of `Scene` that takes them, with an entry in `scenes.table.SCENES`.

The floor of hexapod.xml stays under every scene. For the first `run_up` metres every ground is
that floor, so that an episode starts on it everywhere.
"""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Annotated, Any

import mujoco
import numpy as np
from annotated_types import Interval
from numpy.typing import NDArray

Metres = NDArray[np.float64]

LENGTH = 8.0
"""Where a ground made of pieces ends along the walk, x of odom [m]: who walks as fast as the
reward still tells apart, 0.45 m/s, is at 6.75 m after the 15 s of an episode."""
_DEPTH = 0.1
"""How far a piece reaches below the floor [m]: a foot in its top is nearest to that face."""
_COLOURS = np.array([[0.56, 0.60, 0.64], [0.86, 0.84, 0.78]])
"""Of the lowest and the highest piece of a ground."""


@dataclass(frozen=True)
class CommonOptions:
    """Options that every scene has."""

    friction: Annotated[float, Interval(ge=0.05, le=2.0)]
    """Sliding friction between ground and robot [1]."""
    run_up: Annotated[float, Interval(ge=0.3, le=5.0)]
    """Flat floor ahead of the start; the front feet stand 0.19 m ahead of base_link [m]."""


class Scene(ABC):
    """A ground that does not move; equal options give an equal one, everywhere."""

    @abstractmethod
    def __init__(self, options: Any) -> None:
        """Take the options, of the scene's own type."""

    @abstractmethod
    def build(self, spec: mujoco.MjSpec) -> None:
        """Add what the floor does not have to a model, by `add_box` and `add_ground`."""

    @abstractmethod
    def height(self, x: Any, y: Any) -> Metres:
        """Return the height of the ground over odom's origin [m].

        Args:
            x: Where, in odom [m]; a number or an array.
            y: Likewise, of a shape that goes with x.
        """


def add_ground(spec: mujoco.MjSpec, **attributes: Any) -> None:
    """Add a geom that robots stand on to a model's world."""
    spec.worldbody.add_geom(contype=0, conaffinity=1, group=0, **attributes)


def add_box(
    spec: mujoco.MjSpec, x: tuple[float, float], y: tuple[float, float], top: float, shade: float
) -> None:
    """Add a block of ground.

    Args:
        spec: The model.
        x: From where to where, in odom [m].
        y: Likewise.
        top: Height of its top [m].
        shade: Of its colour, 0 to 1.
    """
    low, high = np.array([x[0], y[0], -_DEPTH]), np.array([x[1], y[1], top])
    colour = _COLOURS[0] + shade * (_COLOURS[1] - _COLOURS[0])
    add_ground(
        spec,
        type=mujoco.mjtGeom.mjGEOM_BOX,
        pos=(low + high) / 2,
        size=(high - low) / 2,
        rgba=[*colour, 1.0],
    )
