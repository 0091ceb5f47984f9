# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What TD3 and SAC have in common: a replay buffer, and groups of updates."""

from abc import abstractmethod
from collections.abc import Mapping
from typing import Any, Protocol, cast

import numpy as np
import torch
from hexapod_sim.task import Outcome
from numpy.typing import NDArray
from stable_baselines3.common.off_policy_algorithm import OffPolicyAlgorithm
from stable_baselines3.common.type_aliases import ReplayBufferSamples

from hexapod_agent.algorithms.learner import Learner, Metrics, Problem
from hexapod_agent.algorithms.policies import MlpPolicy
from hexapod_agent.algorithms.replay import Batch, ReplayBuffer
from hexapod_agent.algorithms.stable_baselines.config import OffPolicySection
from hexapod_agent.algorithms.stable_baselines.model import (
    Seen,
    completed,
    fill_bias,
    int_seed,
    rate_schedule,
    restore,
    set_rate_share,
    state_of,
    torch_generator,
)


class Trainable(Protocol):
    """The update of an off-policy model of the library."""

    def train(self, gradient_steps: int, batch_size: int) -> None:
        """Take gradient steps."""


class Samples:
    """Draws from our replay buffer what the library's updates ask theirs for."""

    def __init__(self, replay: ReplayBuffer, batch: Batch, generator: np.random.Generator) -> None:
        self._replay, self._batch, self._generator = replay, batch, generator
        self._none_done = torch.zeros_like(batch.reward[0])

    def sample(self, batch_size: int, env: object = None) -> ReplayBufferSamples:
        """Return the transitions of one update."""
        self._replay.sample(self._generator, self._batch)
        drawn = self._batch.inner(0)
        return ReplayBufferSamples(
            drawn.observation,
            drawn.action,
            drawn.next_observation,
            self._none_done,  # a fall is a bootstrap of 0
            drawn.reward,
            drawn.bootstrap,
        )


class OffPolicyLearner(Learner):
    """See `Learner`; it resumes to the last bit.

    Attributes:
        exploration: Draws what the actions deviate by.
        model: The library's networks and updates.
    """

    logged: Mapping[str, str]
    """The library's names of metrics, by ours."""

    def __init__(
        self, section: OffPolicySection, group_size: int, problem: Problem, seed: int
    ) -> None:
        """Make a learner of a section of a specification that updates in such groups."""
        self._section, self._group_size = section, group_size
        sizes = problem.observation_size, problem.action_size
        networks, exploration, replay, updates = np.random.SeedSequence(seed).spawn(4)
        self.exploration = np.random.default_rng(exploration)
        self._replay_generator = np.random.default_rng(replay)
        self._generator = torch_generator(updates)
        self._replay = ReplayBuffer(section.buffer_size, *sizes, section.discount, section.n_step)
        batch = Batch.empty(1, section.batch_size, *sizes, torch.float32)
        model = self.new_model(problem)
        model.replay_buffer = cast(Any, Samples(self._replay, batch, self._replay_generator))
        self.model = completed(model, problem, int_seed(networks))
        self._set_level(section.initial_value * section.reward_scale)
        self._policy = self.prepare(self._generator)
        self._seen = Seen(self.model, self.logged)
        self.output = np.zeros(problem.action_size, np.float32)
        self._action: NDArray[np.float32] | None = None
        self._step = 0

    def _set_level(self, value: float) -> None:
        """Let all critics give every action such a value at first."""
        critics: Any = self.model
        for critic in (critics.critic, critics.critic_target):
            for network in critic.q_networks:
                fill_bias(network, value)

    @abstractmethod
    def new_model(self, problem: Problem) -> OffPolicyAlgorithm:
        """Return the library's model, without networks."""

    @abstractmethod
    def prepare(self, generator: torch.Generator) -> MlpPolicy:
        """Let the model's updates draw from a generator, and return its policy."""

    @abstractmethod
    def explored(self, features: NDArray[np.float32]) -> NDArray[np.float32]:
        """Return the action that is taken where the last hidden layer is `features`."""

    def arguments(self) -> dict[str, Any]:
        """Return what every model is made with."""
        section = self._section
        return {
            'policy': 'MlpPolicy', 'env': None, 'device': 'cpu',
            'learning_rate': rate_schedule(section.learning_rate),
            'tau': section.target_smoothing, 'gamma': section.discount,
            'policy_kwargs': {'net_arch': list(section.hidden)}, '_init_setup_model': False,
        }  # fmt: skip

    def begin_episode(self, rate_share: float) -> None:
        """Begin an episode."""
        set_rate_share(self.model, rate_share)
        self._action = None

    def act(self, observation: NDArray[np.float32], explore: bool) -> NDArray[np.float32]:
        """Choose an action, with exploration or without."""
        features = self._policy.features(observation)
        self.output = self._policy.bounded(self._policy.outputs(features))
        if not explore:
            return self.output
        self._action = self.explored(features)
        return self._action

    def store(self, observation: NDArray[np.float32], outcome: Outcome) -> None:
        """Add the transition that ends in `observation`, or begin an episode with it."""
        self._step = outcome.step
        if self._action is None:
            self._replay.begin(observation)
            return
        reward = outcome.reward * self._section.reward_scale
        self._replay.add(self._action, reward, observation, outcome.terminated)

    def update(self) -> Metrics:
        """Take a group of gradient steps where it is time for one and there is a batch."""
        section = self._section
        if (self._step + 1) % section.update_every or len(self._replay) < section.batch_size:
            return {}
        cast(Trainable, self.model).train(self._group_size, section.batch_size)
        return self._seen.metrics(self._group_size)

    def policy(self) -> MlpPolicy:
        """Return the actor, on its own memory."""
        return self._policy

    def state_dict(self) -> dict[str, Any]:
        """Return networks, optimisers, replay buffer and random states."""
        return {
            'model': state_of(self.model),
            'seen': dict(self._seen.values),
            'exploration': self.exploration.bit_generator.state,
            'replay_generator': self._replay_generator.bit_generator.state,
            'generator': self._generator.get_state(),
            'replay': self._replay.state(),
        }

    def load_state_dict(self, state: Mapping[str, Any]) -> None:
        """Take over what `state_dict` gave, of a learner with the same configuration."""
        restore(self.model, state['model'])
        self._seen.values = dict(state['seen'])
        self.exploration.bit_generator.state = state['exploration']
        self._replay_generator.bit_generator.state = state['replay_generator']
        self._generator.set_state(state['generator'])
        self._replay.restore(state['replay'])
