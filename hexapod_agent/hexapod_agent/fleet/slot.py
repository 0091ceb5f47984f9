# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A run's slot in a fleet, and what the fleet asks of a run."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from hexapod_sim.task import EVALUATION_SEED, Outcome
from numpy.typing import NDArray

from hexapod_agent.fleet.robots import PatternError
from hexapod_agent.learning.evaluator import Evaluator
from hexapod_agent.learning.player import Agent
from hexapod_agent.learning.summary import EpisodeSummary
from hexapod_agent.learning.training import Trainer, TrainingDivergedError
from hexapod_agent.specification.observation import ObservationError
from hexapod_agent.specification.run_spec import RunSpec


class Run(Protocol):
    """A training run, and what becomes of it."""

    trainer: Trainer
    """The run, between two episodes when it is admitted."""
    episodes: int
    """How many it is to have."""

    @property
    def saves_next(self) -> bool:
        """Whether `episode_ended` will save the trainer after the episode that is under way."""

    def episode_ended(self, summary: EpisodeSummary) -> None:
        """Take note of an episode."""

    def evaluated(self, summary: EpisodeSummary) -> None:
        """Take note of an episode of the evaluation that follows the last one."""

    def ended(self) -> None:
        """Take note that the last episode is over."""

    def failed(self, error: Exception) -> None:
        """Take note that the run cannot go on."""


@dataclass
class Slot:
    """A run in a slot of the fleet.

    Attributes:
        index: Its number in every batch.
        run: Who is there.
        observation: What its robot observes now (size,); undefined while it waits.
        outcome: What its last step earned; likewise.
        waits: Whether its next episode has not begun yet.
        fault: Why the run cannot go on; no job is done for it any more.
        player: Plays what the run has learned, once it is being evaluated.
    """

    index: int
    run: Run
    observation: NDArray[np.float32] = field(init=False)
    outcome: Outcome = field(init=False)
    waits: bool = True
    fault: Exception | None = None
    player: Evaluator | None = None

    @property
    def trainer(self) -> Trainer:
        """The run's learner and its bookkeeping."""
        return self.run.trainer

    @property
    def agent(self) -> Agent:
        """Who drives the robot."""
        return self.player or self.trainer

    @property
    def next_episode(self) -> tuple[int, int]:
        """Seed of the run whose start the next episode has, and its number there."""
        if self.player is not None:
            return EVALUATION_SEED, self.player.start
        return self.trainer.seed, self.trainer.episode

    @property
    def config(self) -> RunSpec:
        """The specification in whose world the next episode is."""
        return self.trainer.config if self.player is None else self.player.config

    @property
    def is_last(self) -> bool:
        """Whether the episode of the training that is under way is its last one."""
        return self.trainer.episode + 1 >= self.run.episodes

    @property
    def is_done(self) -> bool:
        """Whether there is no further episode."""
        if self.trainer.episode < self.run.episodes:
            return False
        if self.player is None:
            return not self.trainer.config.training.evaluation
        return self.player.is_done

    def end_episode(self) -> None:
        """Close an episode, of the training or of the evaluation that follows it."""
        is_reported = self.player is not None and self.player.is_reported
        summary = self.agent.end_episode(self.observation, self.outcome)
        if is_reported:
            self.run.evaluated(summary)
        if self.player is not None:
            return
        self.run.episode_ended(summary)
        if self.trainer.episode >= self.run.episodes:
            self.player = self.trainer.evaluator()

    @property
    def steps(self) -> bool:
        """Whether its robot is in an episode and goes on."""
        return self.fault is None and not self.waits

    def guard(self, job: Callable[[], None]) -> None:
        """Do something for this run alone; a failure of its training is its own fault."""
        if self.fault is not None:
            return
        try:
            job()
        except (TrainingDivergedError, ObservationError, PatternError) as error:
            self.fault = error
