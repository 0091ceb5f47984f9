# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What a training reports of one episode, and the message EpisodeResult carries."""

import math
from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
from hexapod_sim.task import Outcome
from numpy.typing import NDArray

from hexapod_agent.algorithms.learner import Metrics
from hexapod_agent.learning.metrics import SATURATED_SHARE, UPDATES, in_order

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
        metrics: What the learner saw, by the names of `metrics.METRICS` and others that it has;
            means over the episode's updates, NaN if there was none.
    """

    episode: int
    steps: int
    episode_return: float
    average_return: float
    terms: dict[str, float]
    terminated: bool
    cause: str
    metrics: Mapping[str, float]


class EpisodeRecord:
    """Sums over the episode that is running.

    Attributes:
        episode_return: Sum of the rewards so far.
    """

    def __init__(self, episode: int, names: Iterable[str] = ()) -> None:
        """Begin an episode, with the names of what its updates report."""
        self._episode = episode
        self.episode_return = 0.0
        self._terms: defaultdict[str, float] = defaultdict(float)
        self._updated = defaultdict(float, dict.fromkeys(names, 0.0))
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

    def add_updates(self, seen: Metrics) -> None:
        """Count gradient steps, by what they saw."""
        for name, values in seen.items():
            for value in values.tolist():  # in this order, to the last bit
                self._updated[name] += value
        self._updates += max((values.size for values in seen.values()), default=0)

    def summarize(self, last: Outcome, average_return: float) -> EpisodeSummary:
        """Close the episode with its last outcome."""
        updates = self._updates or math.nan
        seen = {name: total / updates for name, total in self._updated.items()}
        own = {
            SATURATED_SHARE: self._saturated / max(self._outputs, 1),
            UPDATES: float(self._updates),
        }
        return EpisodeSummary(
            episode=self._episode,
            steps=last.step,
            episode_return=self.episode_return,
            average_return=average_return,
            terms=dict(self._terms),
            terminated=last.terminated,
            cause=last.cause,
            metrics=in_order(seen | own),
        )
