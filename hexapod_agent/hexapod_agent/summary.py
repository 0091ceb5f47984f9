# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What a training reports of one episode; the message EpisodeResult has the same fields."""

import math
from collections import defaultdict
from dataclasses import dataclass

import numpy as np
from hexapod_sim.task import Outcome
from numpy.typing import NDArray

SATURATED = 0.95  # an actor's output beyond this counts as saturated


@dataclass(frozen=True)
class EpisodeSummary:
    """One finished episode.

    Attributes:
        episode: Number, from 0.
        steps: Control periods.
        episode_return: Sum of the rewards, exploration noise included.
        average_return: Mean of the last `window` returns, this one included.
        terms: Sum of each reward term.
        terminated: Whether it ended by a failure.
        cause: Why it ended.
        critic_loss: Mean over the episode's updates; NaN if there was none. So the next two.
        actor_loss: Loss of the actor, with its penalty.
        mean_q: Value that the critic gives to the policy's actions.
        saturated_share: Share of the actor's outputs beyond +-0.95, noise apart.
        updates: Gradient steps taken.
    """

    episode: int
    steps: int
    episode_return: float
    average_return: float
    terms: dict[str, float]
    terminated: bool
    cause: str
    critic_loss: float
    actor_loss: float
    mean_q: float
    saturated_share: float
    updates: int


class EpisodeRecord:
    """Sums over the episode that is running.

    Attributes:
        episode_return: Sum of the rewards so far.
    """

    def __init__(self, episode: int) -> None:
        self._episode = episode
        self.episode_return = 0.0
        self._terms: defaultdict[str, float] = defaultdict(float)
        self._losses = np.zeros(3)
        self._updates = 0
        self._saturated = 0
        self._outputs = 0

    def add_outcome(self, outcome: Outcome) -> None:
        """Count one control period."""
        self.episode_return += outcome.reward
        for name, value in outcome.terms.items():
            self._terms[name] += value

    def add_output(self, output: NDArray[np.float32]) -> None:
        """Count the actor's output of one control period, before noise."""
        self._saturated += int(np.count_nonzero(np.abs(output) > SATURATED))
        self._outputs += output.size

    def add_update(self, critic_loss: float, actor_loss: float, mean_q: float) -> None:
        """Count one gradient step."""
        self._losses += (critic_loss, actor_loss, mean_q)
        self._updates += 1

    def summarize(self, last: Outcome, average_return: float) -> EpisodeSummary:
        """Close the episode with its last outcome."""
        losses = self._losses / self._updates if self._updates else np.full(3, math.nan)
        return EpisodeSummary(
            episode=self._episode,
            steps=last.step,
            episode_return=self.episode_return,
            average_return=average_return,
            terms=dict(self._terms),
            terminated=last.terminated,
            cause=last.cause,
            critic_loss=float(losses[0]),
            actor_loss=float(losses[1]),
            mean_q=float(losses[2]),
            saturated_share=self._saturated / max(self._outputs, 1),
            updates=self._updates,
        )
