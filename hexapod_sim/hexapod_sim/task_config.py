# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Weights, scales and limits of the line-following task."""

from dataclasses import dataclass
from typing import Annotated, Any

from annotated_types import Interval

from hexapod_sim import robot
from hexapod_sim.article import section

_PERIOD_S = robot.CONTROL_PERIOD_NS * 1e-9

# What the parameters may be, least and greatest; nothing divides by zero.
_Steps = Annotated[int, Interval(ge=1, le=1_000_000)]
_Place = Annotated[float, Interval(ge=-1e3, le=1e3)]
_Distance = Annotated[float, Interval(ge=0.0, le=1e6)]
_Duration = Annotated[float, Interval(ge=0.0, le=1e6)]
_Weight = Annotated[float, Interval(ge=0.0, le=1e3)]
_Reward = Annotated[float, Interval(ge=-1e3, le=1e3)]
_Scale = Annotated[float, Interval(ge=1e-3, le=1e3)]
_Share = Annotated[float, Interval(ge=0.0, le=1.0)]
_Angle = Annotated[float, Interval(ge=0.0, le=10.0)]


@dataclass(frozen=True)
class TaskConfig:
    """Weights, scales and limits of the task; article.yaml has their values.

    With those every step within 0.75 m of the line is positive while the robot does not walk
    backwards, whatever its attitude, so that ending the episode early never pays there: closeness
    and the constant earn more than the two penalties take. Farther away a step may cost, down to
    -6 for a robot that is about to stray, backwards, flipped and low.
    """

    time_limit_steps: _Steps
    """Control periods of a full episode (15 s)."""
    start_offset: _Distance
    """Largest distance from the line at the start [m]; drawn uniformly to either side."""
    line_y: _Place
    """Where the goal line runs along odom's x axis, or the middle of where it jumps [m]."""
    line_jump: _Place
    """Distance of a jumping line from line_y [m]; it begins on the right."""
    line_period: _Duration
    """Time between two jumps [s]; 0 keeps the line at line_y."""

    velocity_weight: _Weight
    """Reward per unit of the velocity term."""
    closeness_weight: _Weight
    """Reward per unit of the closeness term."""
    orientation_weight: _Weight
    """Cost per unit of the orientation penalty."""
    height_weight: _Weight
    """Cost per unit of the height penalty."""
    alive_reward: _Reward
    """Constant earned in every step."""

    velocity_scale: _Scale
    """Speed along the line that earns one [m/s]."""
    orientation_scale: _Scale
    """Angle from upright, or from the line's direction, that costs one [rad]."""
    yaw_share: _Share
    """How much of the squared yaw enters the orientation penalty: 1 as roll and pitch, 0 none."""
    walking_height: _Scale
    """Mean height of base_link above the ground in the constant gait, measured [m]."""
    height_scale: _Scale
    """Share of the walking height whose error costs one."""

    max_tilt: _Angle
    """Roll or pitch beyond which the robot counts as flipped [rad]."""
    min_height: _Place
    """Height of base_link above the ground beneath, below which the robot has collapsed [m]."""
    max_offset: _Distance
    """Distance from the line beyond which the robot counts as strayed [m]."""

    @classmethod
    def of_article(cls, **changes: Any) -> 'TaskConfig':
        """Return the task of article.yaml, with some values changed."""
        return cls(**section('task') | changes)

    @property
    def farthest(self) -> float:
        """Greatest |y| that the line or a start may have [m]."""
        return abs(self.line_y) + abs(self.line_jump) + self.start_offset

    def __post_init__(self) -> None:
        """Refuse a period that no count of control periods makes.

        Raises:
            ValueError: The line would jump more often than the robot is controlled.
        """
        if self.line_period and not self.line_period >= _PERIOD_S:
            raise ValueError(
                f'line_period {self.line_period} s: expected 0, or at least the control period '
                f'of {_PERIOD_S} s'
            )
