# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Servos that are weaker than they were built."""

from dataclasses import dataclass
from typing import Annotated

import mujoco
from annotated_types import Interval

from hexapod_sim.robot import JOINTS
from hexapod_sim.variations.variation import Variation, weaken


@dataclass(frozen=True)
class MotorStrengthOptions:
    """Options of weak motors."""

    motor_strength: Annotated[float, Interval(ge=0.05, le=2.0)]
    """Motor strength: share of the torque, of all servos and at every position error [1]."""


class MotorStrength(Variation):
    """All servos by the same share."""

    def __init__(self, options: MotorStrengthOptions) -> None:
        """Take the share."""
        self._strength = options.motor_strength

    @property
    def is_present(self) -> bool:
        """Whether it is not all of it."""
        return self._strength != 1.0

    def apply(self, spec: mujoco.MjSpec) -> None:
        """Scale the torque of every servo."""
        weaken(spec, JOINTS, self._strength)
