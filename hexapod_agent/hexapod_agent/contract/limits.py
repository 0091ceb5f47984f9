# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""How far a sensor may depart from what the agent was trained with before the check refuses it."""

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Limits:
    """Tolerances of the sensor contract, topics by their names in the sensor table."""

    max_age: float = 0.1
    """Most that a channel's stamps may lie behind or before the others', and longest usual time
    between two samples [s]."""
    silence: float = 0.5
    """Time without a message after which a topic counts as stopped [s]."""
    least_rate: float = 0.9
    """Samples per control period below which the agent sees values twice."""
    clipped_share: float = 0.05
    """Share of the numbers that may lie beyond the normalising scale."""
    norm_error: float = 0.01
    """Largest departure of a quaternion's norm from 1."""
    gravity_error: float = 0.15
    """Largest departure of the mean specific force from 9.81 m/s^2, relative."""
    max_tilt: float = 1.0
    """Roll or pitch beyond which the robot is not on its way but lies on its side [rad]."""
    frames: Mapping[str, str] = field(default_factory=dict)
    """Frames that drivers use for axes equal to ours, by topic."""
    ages: Mapping[str, float] = field(default_factory=dict)
    """What stands in for `max_age`, by topic [s]."""

    def age(self, topic: str) -> float:
        """Return the `max_age` of a topic [s]."""
        return self.ages.get(topic, self.max_age)

    def __post_init__(self) -> None:
        """Refuse tolerances that are not positive."""
        for name, value in vars(self).items():
            if isinstance(value, float) and not value > 0.0:
                raise ValueError(f'{name} {value:g}: expected a positive number')


def parse_frames(text: str) -> dict[str, str]:
    """Return the frames of `topic=frame` words.

    Raises:
        ValueError: a word is not of that form.
    """
    pairs = [word.partition('=') for word in text.split()]
    for topic, equals, frame in pairs:
        if not (topic and equals and frame):
            raise ValueError(f"frames '{topic}{equals}{frame}': expected <topic>=<frame>")
    return {topic: frame for topic, _, frame in pairs}
