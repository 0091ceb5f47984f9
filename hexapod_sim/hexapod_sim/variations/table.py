# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""All variations, and the section `robot` of a specification."""

from dataclasses import dataclass, replace
from typing import Annotated, Any

from annotated_types import Interval

from hexapod_sim.article import section
from hexapod_sim.variations.blocked_joint import BlockedJointOptions, BlockedJoints, check_angle
from hexapod_sim.variations.dead_legs import DeadLegs, DeadLegsOptions
from hexapod_sim.variations.legs import check_legs
from hexapod_sim.variations.missing_legs import MissingLegs, MissingLegsOptions
from hexapod_sim.variations.motor_strength import MotorStrength, MotorStrengthOptions
from hexapod_sim.variations.payload import Payload, PayloadOptions
from hexapod_sim.variations.variation import Variation

VARIATIONS: tuple[type[Variation], ...] = (
    Payload,
    MotorStrength,
    DeadLegs,
    BlockedJoints,
    MissingLegs,
)
"""In the order in which they are applied."""


@dataclass(frozen=True)
class RobotConfig(
    MotorStrengthOptions,
    BlockedJointOptions,
    MissingLegsOptions,
    DeadLegsOptions,
    PayloadOptions,
):
    """How the robot differs from the one that was built, and from when on."""

    fault_time: Annotated[float, Interval(ge=0.0, le=1e4)]
    """When the variations come; 0: they are there when an episode begins [s]."""

    @classmethod
    def of_article(cls, **changes: Any) -> 'RobotConfig':
        """Return the robot of article.yaml, as it was built, with some values changed."""
        return cls(**section('robot') | changes)

    def __post_init__(self) -> None:
        """Refuse what cannot be.

        Raises:
            ValueError: A leg or joint is unknown, or does not reach its angle.
        """
        for name in ('dead_legs', 'missing_legs'):
            try:
                check_legs(getattr(self, name))
            except ValueError as error:
                raise ValueError(f'robot.{name}: expected {error}') from error
        check_angle(self)

    @property
    def variations(self) -> list[Variation]:
        """Those that are asked for."""
        return [found for kind in VARIATIONS if (found := kind(self)).is_present]

    @property
    def undamaged(self) -> 'RobotConfig':
        """The robot as it was built."""
        return replace(self, **section('robot'))
