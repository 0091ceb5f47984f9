# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The evaluation that ends a training: what is played, in which world, and how it is judged."""

from dataclasses import asdict, replace

import numpy as np
from hexapod_sim.recovery import LATE_STEPS, has_recovered
from hexapod_sim.task import Outcome
from hexapod_sim.task_config import TaskConfig
from numpy.typing import NDArray

from hexapod_agent.algorithms.policies import Policy
from hexapod_agent.learning.metrics import LATE_SPEED, RECOVERED
from hexapod_agent.learning.player import Player
from hexapod_agent.learning.summary import EpisodeSummary
from hexapod_agent.specification.run_spec import RunSpec


class Evaluator(Player):
    """Plays what a run has learned from the starts of its evaluation.

    Of a varied robot the same starts are played first with the robot as it was built: those
    episodes are not part of the evaluation, and tell how fast the agent walks undamaged. Speeds
    are as the reward counts them: from -1 to 1.5 of the scale in each control period.

    Attributes:
        config: The specification in whose world the next episode is.
        start: Number of the next episode.
        is_reported: Whether the next episode is one of the evaluation.
    """

    def __init__(self, policy: Policy, config: RunSpec) -> None:
        """Begin before the first episode.

        Args:
            policy: From observation to action.
            config: The run's specification.
        """
        self._count = config.training.evaluation
        super().__init__(policy, self._count)
        self._varied = config
        self.start = 0
        self.is_reported = not config.robot.variations
        self.config = config
        if not self.is_reported:
            undamaged = {'robot': asdict(config.robot.undamaged)}
            self.config = config.changed(undamaged, 'the robot as it was built')
        self._speeds: list[float] = []
        """Along the line, of each control period of the episode, m/s."""
        self._undamaged: list[float] = []
        """Late speeds of the robot as it was built, m/s."""

    @property
    def is_done(self) -> bool:
        """Whether there is no further episode."""
        return self.is_reported and self.start >= self._count

    def begin_episode(self, episode: int) -> None:
        """Start episode number `start`."""
        super().begin_episode(episode)
        self._speeds.clear()

    def observe(self, observation: NDArray[np.float32], outcome: Outcome) -> NDArray[np.float32]:
        """Count the step that ends here, and act as the policy says."""
        if outcome.step:
            self._speeds.append(_speed(outcome, self.config.task))
        return super().observe(observation, outcome)

    def end_episode(self, observation: NDArray[np.float32], outcome: Outcome) -> EpisodeSummary:
        """Count the last step, close the episode and go on to the next one."""
        self._speeds.append(_speed(outcome, self.config.task))
        late_speed = float(np.mean(self._speeds[-LATE_STEPS:]))
        summary = super().end_episode(observation, outcome)
        self.start += 1
        if not self.is_reported:
            self._undamaged.append(late_speed)
            if self.start >= self._count:
                self.config, self.start, self.is_reported = self._varied, 0, True
                self._returns.clear()
        elif self._undamaged:
            undamaged = float(np.mean(self._undamaged))
            recovered = has_recovered(outcome.terminated, late_speed, undamaged)
            own = {LATE_SPEED: late_speed, RECOVERED: float(recovered)}
            summary = self._summary = replace(summary, metrics={**summary.metrics, **own})
        return summary


def _speed(outcome: Outcome, config: TaskConfig) -> float:
    """Return the speed along the line that a control period earned by, m/s; 0 if it earns none."""
    if not config.velocity_weight:
        return 0.0
    return outcome.terms['velocity'] / config.velocity_weight * config.velocity_scale
