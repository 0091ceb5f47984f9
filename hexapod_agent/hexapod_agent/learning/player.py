# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Plays a trained agent: the verbs of `Trainer`, without noise and without learning."""

from typing import Protocol

import numpy as np
from hexapod_sim.task import Outcome
from numpy.typing import NDArray

from hexapod_agent.algorithms.policies import Policy
from hexapod_agent.learning.summary import EpisodeRecord, EpisodeSummary


class Agent(Protocol):
    """What drives the robot through the episodes of a run: a `Trainer` or a `Player`."""

    @property
    def summary(self) -> EpisodeSummary:
        """The last complete episode."""

    def begin_episode(self, episode: int) -> None:
        """Start an episode."""

    def observe(self, observation: NDArray[np.float32], outcome: Outcome) -> NDArray[np.float32]:
        """Take in the step that ends here, and choose the next action."""

    def learn(self) -> None:
        """Use the time while the others step."""

    def end_episode(self, observation: NDArray[np.float32], outcome: Outcome) -> EpisodeSummary:
        """Take in the last step."""


class Player:
    """Runs episodes with a policy that stays as it is."""

    def __init__(self, policy: Policy, window: int) -> None:
        """Begin before the first episode.

        Args:
            policy: From observation to action.
            window: Episodes that the average return is taken over.
        """
        self._policy = policy
        self._window = window
        self._returns: list[float] = []
        self._record = EpisodeRecord(0)
        self._summary: EpisodeSummary | None = None

    @property
    def summary(self) -> EpisodeSummary:
        """The last complete episode; what a learner would fill in is NaN."""
        if self._summary is None:
            raise RuntimeError('summary: no episode is complete yet')
        return self._summary

    def begin_episode(self, episode: int) -> None:
        """Start episode number `episode`."""
        self._record = EpisodeRecord(episode)

    def observe(self, observation: NDArray[np.float32], outcome: Outcome) -> NDArray[np.float32]:
        """Count the step that ends here, and act as the policy says."""
        if outcome.step:
            self._record.add_outcome(outcome)
        action = self._policy(observation)
        self._record.add_output(action)
        return action

    def learn(self) -> None:
        """Learn nothing."""

    def end_episode(self, observation: NDArray[np.float32], outcome: Outcome) -> EpisodeSummary:
        """Count the last step and close the episode."""
        self._record.add_outcome(outcome)
        self._returns.append(self._record.episode_return)
        average = float(np.mean(self._returns[-self._window :]))
        self._summary = self._record.summarize(outcome, average)
        return self._summary
