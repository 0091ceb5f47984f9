# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The line-following task: start offsets, reward terms and the ends of an episode."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hexapod_sim import robot
from hexapod_sim.quality import Qualities
from hexapod_sim.sensors import Sensors
from hexapod_sim.simulation import Simulation, SimulationDivergedError
from hexapod_sim.sums import ordered_sum
from hexapod_sim.task_config import TaskConfig
from hexapod_sim.world import World

_PERIOD_S = robot.CONTROL_PERIOD_NS * 1e-9
TERM_NAMES = ('velocity', 'closeness', 'orientation', 'height', 'alive')
DIVERGED = 'diverged'
"""Cause of an episode's end that no pose shows: the physics was lost."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """What one control period earned, and whether the episode goes on."""

    step: int
    """Control periods since the episode began; 0 is the start and earns nothing."""
    reward: float
    """Sum of the terms."""
    terms: dict[str, float]
    """Weighted reward terms by name."""
    terminated: bool
    """The episode failed here: no future reward."""
    truncated: bool
    """The time limit was reached: the future goes on."""
    cause: str
    """Why the episode ended; empty while it runs."""


def episode_seed(run_seed: int, episode: int) -> int:
    """Return the seed of one episode (uint64), well mixed from the run's seed and its number."""
    return int(np.random.SeedSequence((run_seed, episode)).generate_state(1, np.uint64)[0])


EVALUATION_SEED = 2**63
"""Seed of the starts that every run is evaluated at: no run's own, which are less."""


def line_at(step: int, config: TaskConfig) -> float:
    """Return where the goal line runs after so many control periods [m].

    It is at y0 - d and y0 + d in turn, for round(T / Ts) control periods each.
    """
    if not config.line_period:
        return config.line_y
    jumps = step // round(config.line_period / _PERIOD_S)
    return config.line_y + (config.line_jump if jumps % 2 else -config.line_jump)


def velocity_term(velocity: float, config: TaskConfig) -> float:
    """Reward speed along the line, linear between -1 and 1.5 times the scale."""
    return min(max(velocity / config.velocity_scale, -1.0), 1.5)


def closeness_term(offset: float) -> float:
    """Reward being near the line, with the same slope at every distance."""
    return 1.0 - abs(offset)


def orientation_penalty(roll: float, pitch: float, yaw: float, config: TaskConfig) -> float:
    """Penalise squared tilt and heading error, at most 2."""
    squared = roll * roll + pitch * pitch + config.yaw_share * yaw * yaw
    return min(squared / config.orientation_scale**2, 2.0)


def height_penalty(height: float, config: TaskConfig) -> float:
    """Penalise the squared error from the walking height, at most 2."""
    error = (height - config.walking_height) / (config.height_scale * config.walking_height)
    return min(error * error, 2.0)


def failure_cause(
    roll: float, pitch: float, height: float, offset: float, config: TaskConfig
) -> str:
    """Return why the robot can no longer do the task, or an empty string."""
    if max(abs(roll), abs(pitch)) > config.max_tilt:
        return 'flipped'
    if height < config.min_height:
        return 'collapsed'
    if abs(offset) > config.max_offset:
        return 'strayed'
    return ''


def judge(
    step: int,
    pose: Sequence[float],
    x_before: float,
    offset: float,
    config: TaskConfig,
    ground: float = 0.0,
) -> Outcome:
    """Return what a control period earned, and whether the episode goes on.

    Args:
        step: Control periods since the episode began, this one included.
        pose: x, y, z [m] and roll, pitch, yaw [rad] of base_link in odom, at the period's end.
        x_before: x at the period's begin [m].
        offset: Distance from the line at the period's end [m], positive to the left of it.
        config: Weights, scales and limits.
        ground: Height of the ground under base_link in odom [m].
    """
    x, _, z, roll, pitch, yaw = pose
    height = z - ground
    velocity = (x - x_before) / _PERIOD_S
    terms = {
        'velocity': config.velocity_weight * velocity_term(velocity, config),
        'closeness': config.closeness_weight * closeness_term(offset),
        'orientation': -config.orientation_weight * orientation_penalty(roll, pitch, yaw, config),
        'height': -config.height_weight * height_penalty(height, config),
        'alive': config.alive_reward,
    }
    cause = failure_cause(roll, pitch, height, offset, config)
    terminated = bool(cause)
    truncated = not terminated and step >= config.time_limit_steps
    cause = 'time_limit' if truncated else cause
    return Outcome(step, ordered_sum(terms.values()), terms, terminated, truncated, cause)


def diverged(step: int) -> Outcome:
    """Return the end of an episode whose physics was lost: nothing is earned."""
    return Outcome(step, 0.0, dict.fromkeys(TERM_NAMES, 0.0), True, False, DIVERGED)


class LineTask:
    """Walk along the line y = line_y of odom in +x direction, starting beside it.

    The line may jump by the configuration's schedule: the sample at the end of a control period
    sees it where it is from then on.

    Attributes:
        config: Weights, scales and limits.
        simulation: The robot.
        sensors: What its devices deliver; what a period earned is judged by the truth.
    """

    def __init__(
        self,
        config: TaskConfig,
        qualities: Qualities | None = None,
        world: World | None = None,
    ) -> None:
        self.config = config
        self.simulation = Simulation(world)
        self.sensors = Sensors(self, qualities)
        self._line_y = self.config.line_y
        self._step = 0
        self._x = 0.0
        self._over = True

    @property
    def line_y(self) -> float:
        """Where the goal line runs [m]; may be moved if nothing else moves it."""
        return self._line_y

    @line_y.setter
    def line_y(self, value: float) -> None:
        self._line_y = float(value)
        self.simulation.set_goal_line(self._line_y)

    @property
    def line_offset(self) -> float:
        """Distance of base_link from the line [m], positive to the left of it."""
        return float(self.simulation.data.qpos[1]) - self._line_y

    def enter(self, world: World) -> None:
        """Take another world for the episodes to come; an equal one stays as it is."""
        if world != self.simulation.world:
            self.simulation = Simulation(world)
            self._over = True

    def reset(self, seed: int) -> Outcome:
        """Start an episode: the robot stands beside the line, its offset drawn from the seed."""
        limit = self.config.start_offset
        offset = np.random.default_rng(seed).uniform(-limit, limit)
        line_y = line_at(0, self.config)
        self.simulation.reset(line_y + offset)
        self.line_y = line_y
        self._step = 0
        self._x = 0.0
        self._over = False
        self.sensors.begin(seed)
        return Outcome(0, 0.0, dict.fromkeys(TERM_NAMES, 0.0), False, False, '')

    def advance(self, targets: np.ndarray) -> Outcome:
        """Advance one control period and judge it.

        Args:
            targets: Joint angles (SUBSTEPS, 18) [rad].

        Raises:
            RuntimeError: The episode is over or has not begun.
            ValueError: The targets have a wrong shape or are not finite.
        """
        if self._over:
            raise RuntimeError('line task: expected reset() before advance(), no episode runs')
        y = float(self.simulation.data.qpos[1])
        try:
            self.simulation.advance(targets)
        except SimulationDivergedError:
            return self._diverged(y)
        self._step += 1
        if self.config.line_period:
            self.line_y = line_at(self._step, self.config)
        self.sensors.sample()
        return self._judge()

    def _judge(self) -> Outcome:
        """Return the outcome of the period that just ended."""
        pose = self.simulation.pose()
        ground, offset = self.simulation.ground(*pose[:2]), pose[1] - self._line_y
        outcome = judge(self._step, pose, self._x, offset, self.config, ground)
        self._x = pose[0]
        self._over = outcome.terminated or outcome.truncated
        return outcome

    def _diverged(self, y: float) -> Outcome:
        """End the episode without reward, the robot put back so that its readings are finite."""
        self.simulation.reset(y)
        self.simulation.set_goal_line(self._line_y)
        self._step += 1
        self._over = True
        self.sensors.sample()
        return diverged(self._step)
