# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The robot as a machine that never waits: it plays what it was told last, or holds still."""

import sys
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hexapod_sim import robot
from hexapod_sim.simulation import SimulationDivergedError
from hexapod_sim.task import LineTask, Outcome
from hexapod_sim.task_config import TaskConfig

_STANDING = np.tile(robot.NEUTRAL_POSE, (robot.SUBSTEPS, 1))


class Plant:
    """A task in real time: no episode ends by time, and physics goes on after a failure."""

    def __init__(self, task: LineTask) -> None:
        """Begin before the first episode.

        Args:
            task: Robot and line.
        """
        self._task = task
        self._seed = 0
        self._targets = _STANDING
        self._played = True
        self._outcome: Outcome | None = None

    def reset(self, seed: int, config: TaskConfig) -> Outcome:
        """Put the robot at the seeded start, standing."""
        self._seed = seed
        self._task.config = replace(config, time_limit_steps=sys.maxsize)
        self._targets, self._played = _STANDING, True
        self._outcome = self._task.reset(seed)
        return self._outcome

    def play(self, targets: NDArray[np.float64]) -> None:
        """Let the next control period play joint targets (SUBSTEPS, 18) [rad], if they are new."""
        if targets is not self._targets:
            self._targets, self._played = targets, False

    def advance(self) -> Outcome:
        """Advance one control period with the targets that came last; servos hold the last one.

        Raises:
            RuntimeError: The robot was never put anywhere.
        """
        if self._outcome is None:
            raise RuntimeError('plant: expected reset() before advance()')
        targets = self._targets
        if self._played:
            targets = np.tile(targets[-1], (robot.SUBSTEPS, 1))
        self._played = True
        if not self._outcome.terminated:
            self._outcome = self._task.advance(targets)
            return self._outcome
        try:
            self._task.simulation.advance(targets)
            self._task.sensors.sample()
        except SimulationDivergedError:
            return self.reset(self._seed, self._task.config)
        return self._outcome
