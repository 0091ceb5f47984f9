# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""One training run as a state machine that an environment loop and a ROS node drive alike.

Each control period: `observe`, send the action, `learn`. The result depends on the seed alone,
not on who drives or how long anything takes.
"""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from hexapod_cpg.mapping import ACTION_SIZE
from hexapod_sim.robot import CONTROL_PERIOD_NS
from hexapod_sim.task import Outcome
from numpy.typing import NDArray

from hexapod_agent.algorithms import ALGORITHMS
from hexapod_agent.algorithms.learner import Metrics, Problem
from hexapod_agent.learning.evaluator import Evaluator
from hexapod_agent.learning.numerics import resolved
from hexapod_agent.learning.summary import EpisodeRecord, EpisodeSummary
from hexapod_agent.specification.run_spec import ConfigError, RunSpec


class TrainingDivergedError(RuntimeError):
    """An observation, a reward or a loss is no longer a finite number."""


class Trainer:
    """A run's bookkeeping around what learns.

    Attributes:
        spec: What the agent observes.
        config: The run's specification.
        seed: Seed of everything random.
        learner: What acts and learns.
        episode: Episodes that are complete; a checkpoint is taken between two.
        returns: Return of each complete episode.

    Raises:
        ConfigError: Nothing would be learned.
    """

    def __init__(self, config: RunSpec, seed: int) -> None:
        config = resolved(config)
        self.config, self.seed = config, seed
        self.spec = config.observed
        algorithm = ALGORITHMS[config.learner.algorithm]
        try:
            self.learner = algorithm.learner(config.learner, problem_of(config), seed)
        except ValueError as error:
            raise ConfigError(str(error)) from error
        self.episode = 0
        self.returns: list[float] = []
        self._summary: EpisodeSummary | None = None
        self._record = EpisodeRecord(0)
        self._step = 0

    @property
    def rate_share(self) -> float:
        """Share of the learning rates at which this episode learns."""
        training = self.config.training
        progress = min(self.episode / max(training.episodes - 1, 1), 1.0)
        return float(training.final_rate**progress)

    @property
    def average_return(self) -> float:
        """Mean of the last `window` returns: at the end, the final average reward."""
        window = self.returns[-self.config.training.window :]
        return float(np.mean(window)) if window else math.nan

    @property
    def summary(self) -> EpisodeSummary:
        """The last complete episode."""
        if self._summary is None:
            raise RuntimeError('summary: no episode is complete yet')
        return self._summary

    def evaluator(self) -> Evaluator:
        """Return what plays the agent as it is now: at the end, for the run's evaluation."""
        return Evaluator(self.learner.policy(), self.config)

    def begin_episode(self, episode: int) -> None:
        """Start episode number `episode`, dropping one that was left unfinished.

        Raises:
            ValueError: It is not the next episode of this run.
        """
        if episode != self.episode:
            raise ValueError(f'episode {episode} cannot begin, expected episode {self.episode}')
        self._record = EpisodeRecord(episode, self.learner.metric_names)
        self.learner.begin_episode(self.rate_share)

    def observe(self, observation: NDArray[np.float32], outcome: Outcome) -> NDArray[np.float32]:
        """Store the step that ends here, and choose the next action.

        Args:
            observation: Vector (spec.size,).
            outcome: What the step earned; at the start of an episode, step 0.

        Returns:
            Action (30,) with exploration, within +-1.
        """
        self.store(observation, outcome)
        action = self.learner.act(observation, explore=True)
        self.note_output()
        return action

    def learn(self) -> None:
        """Take the gradient steps that are due after the newest observation."""
        self.note_updates(self.learner.update())

    def note_output(self) -> None:
        """Take note of what the policy put out at the learner's last `act`."""
        self._record.add_output(self.learner.output)

    def note_updates(self, metrics: Metrics) -> None:
        """Take note of what updates saw.

        Raises:
            TrainingDivergedError: It is not finite.
        """
        if not metrics:
            return
        for name, values in metrics.items():
            if not np.isfinite(values).all():
                value = values[~np.isfinite(values)][0]
                raise self._diverged(f'the {name} of an update is {value}')
        self._record.add_updates(metrics)

    def end_episode(self, observation: NDArray[np.float32], outcome: Outcome) -> EpisodeSummary:
        """Store the last step and close the episode."""
        self.store(observation, outcome)
        self.returns.append(self._record.episode_return)
        self._summary = self._record.summarize(outcome, self.average_return)
        self.episode += 1
        return self._summary

    def store(self, observation: NDArray[np.float32], outcome: Outcome) -> None:
        """Add the transition that ends in `observation`, or begin an episode with it.

        Raises:
            TrainingDivergedError: The observation or the reward is not finite.
        """
        self._step = outcome.step
        if not np.isfinite(observation).all():
            index = int(np.flatnonzero(~np.isfinite(observation))[0])
            raise self._diverged(f'{self.spec.locate(index)} is {observation[index]}')
        if not math.isfinite(outcome.reward):
            raise self._diverged(f'the reward is {outcome.reward}')
        self.learner.store(observation, outcome)
        if outcome.step:
            self._record.add_outcome(outcome)

    def _diverged(self, what: str) -> TrainingDivergedError:
        return TrainingDivergedError(
            f'{what}, expected a finite number (step {self._step} of episode {self.episode}, '
            f'seed {self.seed})'
        )

    def state_dict(self) -> dict[str, Any]:
        """Return what changes during a run, between two episodes."""
        return {
            'episode': self.episode,
            'returns': list(self.returns),
            'learner': self.learner.state_dict(),
        }

    def load_state_dict(self, state: Mapping[str, Any]) -> None:
        """Take over what `state_dict` gave, of a run with the same configuration."""
        self.learner.load_state_dict(state['learner'])
        self.episode = state['episode']
        self.returns = list(state['returns'])


def problem_of(config: RunSpec) -> Problem:
    """Return what an algorithm must know of a run."""
    return Problem(
        config.observed.size, ACTION_SIZE, CONTROL_PERIOD_NS * 1e-9, config.task.time_limit_steps,
        config.training.precision,
    )  # fmt: skip
