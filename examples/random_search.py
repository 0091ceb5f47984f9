# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A whole algorithm in a file: the best of random constant actions, one for each episode.

    python examples/random_search.py --observations ABCDE --episodes 20 --out runs/search

takes what `train` takes.
"""

import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import torch
from hexapod_agent.algorithms import ALGORITHMS, Algorithm
from hexapod_agent.algorithms.learner import Learner, LearnerConfig, Metrics, Problem
from hexapod_agent.algorithms.policies import MlpPolicy
from hexapod_agent.algorithms.ranges import Factor
from hexapod_agent.train import main as train
from hexapod_sim.task import Outcome
from numpy.typing import NDArray


@dataclass(frozen=True)
class SearchConfig:
    """The section `learner.search` of a specification."""

    width: Factor


@dataclass(frozen=True)
class RandomSearchConfig(LearnerConfig):
    """What `learner` has with this algorithm."""

    search: SearchConfig = SearchConfig(width=0.5)


class RandomSearch(Learner):
    """Keeps the constant action of the best episode so far."""

    metric_names = ('best_return',)

    def __init__(self, config: RandomSearchConfig, problem: Problem, seed: int) -> None:
        self._width, self._generator = config.search.width, np.random.default_rng(seed)
        weights = np.zeros((problem.action_size, problem.observation_size), np.float32)
        self._weights, self._bias = weights, np.zeros(problem.action_size, np.float32)
        self._tried = self.output = self._bias.copy()
        self._best, self._return = -np.inf, 0.0

    def begin_episode(self, rate_share: float) -> None:
        """Draw the action of an episode."""
        self._return = 0.0
        draw = self._generator.uniform(-self._width, self._width, self._bias.size)
        self._tried = draw.astype(np.float32)

    def act(self, observation: NDArray[np.float32], explore: bool) -> NDArray[np.float32]:
        """Return the action of the episode, or the best one so far."""
        self.output = np.tanh(self._tried if explore else self._bias)
        return self.output

    def store(self, observation: NDArray[np.float32], outcome: Outcome) -> None:
        """Add up what the episode earns."""
        self._return += outcome.reward if outcome.step else 0.0
        if (outcome.terminated or outcome.truncated) and self._return > self._best:
            self._best = self._return
            self._bias[:] = self._tried

    def update(self) -> Metrics:
        """Return what is to be logged; there is nothing to learn within an episode."""
        return {'best_return': np.array([self._best])} if np.isfinite(self._best) else {}

    def policy(self) -> MlpPolicy:
        """Return what acts without a learner."""
        return MlpPolicy(((self._weights, self._bias),))

    def state_dict(self) -> dict[str, Any]:
        """Return what goes on from a checkpoint."""
        generator = self._generator.bit_generator.state
        bias = torch.from_numpy(self._bias)
        return {'bias': bias, 'best': self._best, 'generator': generator}

    def load_state_dict(self, state: Mapping[str, Any]) -> None:
        """Go on from a checkpoint."""
        self._bias[:], self._best = state['bias'].numpy(), state['best']
        self._generator.bit_generator.state = state['generator']


def main(words: Sequence[str] | None = None) -> None:
    """Train, by what the command line says."""
    names = ('random_search:RandomSearchConfig', 'random_search:RandomSearch')
    given = sys.argv[1:] if words is None else words
    ALGORITHMS['random_search'] = Algorithm(*names)
    try:
        train([*given, '--set', 'learner.algorithm=random_search'])
    finally:  # whoever called may have other uses for the table
        del ALGORITHMS['random_search']


if __name__ == '__main__':
    main()
