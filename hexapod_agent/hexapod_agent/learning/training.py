# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""One training run as a state machine that an environment loop and a ROS node drive alike.

Each control period: `observe`, send the action, `learn`. The result depends on the seed alone,
not on who drives or how long anything takes.
"""

import math
from collections.abc import Mapping
from dataclasses import fields
from functools import cached_property
from typing import Any

import numpy as np
import torch
from hexapod_cpg.mapping import ACTION_SIZE
from hexapod_sim.robot import CONTROL_PERIOD_NS
from hexapod_sim.task import Outcome
from numpy.typing import NDArray

from hexapod_agent.algorithms.ddpg.ddpg import Ddpg, UpdateStatistics
from hexapod_agent.algorithms.ddpg.running_scale import RunningScale
from hexapod_agent.algorithms.noise import OrnsteinUhlenbeckNoise
from hexapod_agent.algorithms.replay import Batch, ReplayBuffer
from hexapod_agent.deployment.policies import trained_policy
from hexapod_agent.learning.player import Player
from hexapod_agent.learning.summary import EpisodeRecord, EpisodeSummary
from hexapod_agent.specification.run_spec import ConfigError, RunSpec

_UPDATE_METRICS = tuple(field.name for field in fields(UpdateStatistics))


class TrainingDivergedError(RuntimeError):
    """An observation, a reward or a loss is no longer a finite number."""


class Trainer:
    """Learner, replay buffer, exploration noise and bookkeeping of one run.

    Attributes:
        spec: What the agent observes.
        config: The run's specification.
        seed: Seed of everything random.
        agent: Networks and their update.
        episode: Episodes that are complete; a checkpoint is taken between two.
        returns: Return of each complete episode.

    Raises:
        ConfigError: No episode is as long as a group of updates, or no batch fits into the buffer.
    """

    def __init__(self, config: RunSpec, seed: int) -> None:
        steps, ddpg = config.task.time_limit_steps, config.learner.ddpg
        if ddpg.update_every > steps:
            raise ConfigError(
                f'learner.ddpg.update_every is {ddpg.update_every}, expected at most '
                f'task.time_limit_steps, {steps}: nothing would be learned'
            )
        if ddpg.buffer_size <= ddpg.batch_size:
            raise ConfigError(
                f'learner.ddpg.buffer_size is {ddpg.buffer_size}, expected more than '
                f'learner.ddpg.batch_size, {ddpg.batch_size}: nothing would be learned'
            )
        self.config, self.seed = config, seed
        self.spec = spec = config.observed
        # One thread: a sum split over threads is not the same to the last bit.
        torch.set_num_threads(1)
        precision = config.training.precision
        torch.set_float32_matmul_precision('highest' if precision == 'float32' else 'medium')
        init, noise, replay = np.random.SeedSequence(seed).spawn(3)
        self._replay_generator = np.random.default_rng(replay)
        self._noise_generator = np.random.default_rng(noise)
        self.agent = Ddpg(
            spec.size, ACTION_SIZE, config.learner.actor, config.learner.critic, ddpg.batch_size,
            ddpg.target_smoothing, _torch_generator(init),
            hidden_dtype=torch.bfloat16 if precision == 'bfloat16' else None,
            scale=RunningScale(spec.size) if ddpg.normalize_observations else None,
        )  # fmt: skip
        self._policy = trained_policy(self.agent)
        self._replay = ReplayBuffer(
            ddpg.buffer_size, spec.size, ACTION_SIZE, ddpg.discount, ddpg.n_step
        )
        self._noise = OrnsteinUhlenbeckNoise(
            config.learner.noise, ACTION_SIZE, CONTROL_PERIOD_NS * 1e-9, self._noise_generator
        )
        self.episode = 0
        self.returns: list[float] = []
        self._summary: EpisodeSummary | None = None
        self._record = EpisodeRecord(0)
        self._action: NDArray[np.float32] | None = None
        self._step = 0

    @cached_property
    def _group(self) -> tuple[Batch, list[Batch]]:
        """The batches of a group of updates, all in all and one by one."""
        ddpg = self.config.learner.ddpg
        sizes = (ddpg.batch_size, self.spec.size, ACTION_SIZE)
        drawn = Batch.empty(ddpg.group_size, *sizes, torch.float32)
        return drawn, [drawn.inner(number) for number in range(ddpg.group_size)]

    @property
    def rate_share(self) -> float:
        """Share of the learning rates at which this episode learns."""
        training = self.config.training
        progress = min(self.episode / max(training.episodes - 1, 1), 1.0)
        return 1.0 - (1.0 - training.final_rate) * progress

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

    def evaluator(self) -> Player:
        """Return what plays the agent as it is now: at the end, for the run's evaluation."""
        return Player(self._policy, self.config.training.evaluation)

    def begin_episode(self, episode: int) -> None:
        """Start episode number `episode`, dropping one that was left unfinished.

        Raises:
            ValueError: It is not the next episode of this run.
        """
        if episode != self.episode:
            raise ValueError(f'episode {episode} cannot begin, expected episode {self.episode}')
        self._record = EpisodeRecord(episode, _UPDATE_METRICS)
        self.agent.set_rate_share(self.rate_share)
        if self.agent.scale:
            self.agent.scale.refresh()
        self._noise.reset()
        self._action = None

    def observe(self, observation: NDArray[np.float32], outcome: Outcome) -> NDArray[np.float32]:
        """Store the step that ends here, and choose the next action.

        Args:
            observation: Vector (spec.size,).
            outcome: What the step earned; at the start of an episode, step 0.

        Returns:
            Action (30,) with exploration noise, within +-1.
        """
        self.store(observation, outcome)
        return self.explore(self._policy(observation))

    def explore(self, output: NDArray[np.float32]) -> NDArray[np.float32]:
        """Return the action that is taken where the policy put out (30,): noise is added."""
        self._record.add_output(output)
        action = (output + self._noise.sample()).clip(-1.0, 1.0).astype(np.float32)
        self._action = action
        return action

    def learn(self) -> None:
        """Take the gradient steps that are due after the newest observation."""
        if not self.due:
            return
        drawn, batches = self._group
        self.sample(drawn)
        for batch in batches:
            statistics = self.agent.update(batch)
            self.note_update({name: float(value) for name, value in vars(statistics).items()})

    @property
    def due(self) -> int:
        """Gradient steps to take now: a group of them, where it is time and there is a batch."""
        config = self.config.learner.ddpg
        is_time = (self._step + 1) % config.update_every == 0
        return config.group_size if is_time and len(self._replay) >= config.batch_size else 0

    def sample(self, batch: Batch) -> None:
        """Draw the transitions of the next updates, as many as the batches are, and scale them."""
        self._replay.sample(self._replay_generator, batch)
        if self.agent.scale:
            self.agent.scale.scale(batch.observation)
            self.agent.scale.scale(batch.next_observation)

    def note_update(self, statistics: Mapping[str, float]) -> None:
        """Take note of what an update saw, by the names of `UpdateStatistics`.

        Raises:
            TrainingDivergedError: It is not finite.
        """
        for name, value in statistics.items():
            if not math.isfinite(value):
                raise self._diverged(f'the {name} of an update is {value}')
        self._record.add_update(statistics)

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
        if self.agent.scale:
            self.agent.scale.add(observation)
        if self._action is None:
            self._replay.begin(observation)
            return
        reward = outcome.reward * self.config.learner.ddpg.reward_scale
        self._replay.add(self._action, reward, observation, outcome.terminated)
        self._record.add_outcome(outcome)

    def _diverged(self, what: str) -> TrainingDivergedError:
        return TrainingDivergedError(
            f'{what}, expected a finite number (step {self._step} of episode {self.episode}, '
            f'seed {self.seed})'
        )

    def state_dict(self, to_resume: bool) -> dict[str, Any]:
        """What changes during a run, between two episodes.

        Args:
            to_resume: All of it, so that the run can go on; else what it takes to act.
        """
        state: dict[str, Any] = {'episode': self.episode, 'returns': list(self.returns)}
        if not to_resume:
            return state | {'agent': self.agent.acting_state()}
        return state | {
            'agent': self.agent.state_dict(),
            'replay_generator': self._replay_generator.bit_generator.state,
            'noise_generator': self._noise_generator.bit_generator.state,
            'noise_sigma': self._noise.sigma,
            'replay': self._replay.state(),
        }

    def load_state_dict(self, state: dict[str, Any]) -> None:
        """Take over what `state_dict` gave, of a run with the same configuration."""
        self.agent.load_state_dict(state['agent'])
        self.episode = state['episode']
        self.returns = list(state['returns'])
        if 'replay' in state:
            self._replay_generator.bit_generator.state = state['replay_generator']
            self._noise_generator.bit_generator.state = state['noise_generator']
            self._noise.sigma = state['noise_sigma']
            self._replay.restore(state['replay'])


def _torch_generator(sequence: np.random.SeedSequence) -> torch.Generator:
    """Seed a torch generator from a stream of numpy's."""
    return torch.Generator().manual_seed(int(sequence.generate_state(1, np.uint64)[0]))
