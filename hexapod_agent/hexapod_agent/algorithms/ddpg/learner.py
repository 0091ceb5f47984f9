# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The article's DDPG as a learner: networks, replay buffer and exploration noise of one agent."""

from collections.abc import Mapping
from functools import cached_property
from typing import Any

import numpy as np
import torch
from hexapod_sim.task import Outcome
from numpy.typing import NDArray

from hexapod_agent.algorithms.ddpg.config import DdpgConfig
from hexapod_agent.algorithms.ddpg.ddpg import METRICS, Ddpg
from hexapod_agent.algorithms.ddpg.networks import Actor
from hexapod_agent.algorithms.ddpg.parameters import ParameterStack
from hexapod_agent.algorithms.learner import Learner, LearnerConfig, Metrics, Problem
from hexapod_agent.algorithms.noise import OrnsteinUhlenbeckNoise
from hexapod_agent.algorithms.policies import MlpPolicy
from hexapod_agent.algorithms.replay import Batch, ReplayBuffer


class DdpgLearner(Learner):
    """See `Learner`.

    Attributes:
        problem: Sizes and lengths.
        networks: Networks and their update.
        rate_shares: Shares of the actor's and the critic's learning rate in this episode.
    """

    metric_names = METRICS

    def __init__(self, config: DdpgConfig, problem: Problem, seed: int) -> None:
        config.check_training(problem.episode_steps)
        ddpg = config.ddpg
        self._config, self.problem = ddpg, problem
        self._actor_waits = config.actor.waits
        sizes = problem.observation_size, problem.action_size
        init, noise, replay = np.random.SeedSequence(seed).spawn(3)
        self._replay_generator = np.random.default_rng(replay)
        self._noise_generator = np.random.default_rng(noise)
        self.networks = Ddpg(
            *sizes, config, _torch_generator(init), compute_dtype=compute_dtype(problem.precision)
        )
        self._policy = policy_of(self.networks.actor_parameters)
        self._replay = ReplayBuffer(ddpg.buffer_size, *sizes, ddpg.discount, ddpg.n_step)
        self._noise = OrnsteinUhlenbeckNoise(
            config.noise, sizes[1], problem.period_s, self._noise_generator
        )
        self.rate_shares = (1.0, 1.0)
        self.output = np.zeros(sizes[1], np.float32)
        self._action: NDArray[np.float32] | None = None
        self._step = 0
        self._updates = 0

    def begin_episode(self, rate_share: float) -> None:
        """Begin an episode, with noise at its mean."""
        waits = self._updates < self._actor_waits
        self.rate_shares = (0.0 if waits else rate_share, rate_share)
        self.networks.set_rate_shares(*self.rate_shares)
        self._noise.reset()
        self._action = None

    def act(self, observation: NDArray[np.float32], explore: bool) -> NDArray[np.float32]:
        """Choose an action, with Ornstein-Uhlenbeck noise if it is to explore."""
        self.output = self._policy(observation)
        return self.explore(self.output) if explore else self.output

    def explore(self, output: NDArray[np.float32]) -> NDArray[np.float32]:
        """Return the action that is taken where the policy put out (action size,)."""
        self.output = output
        self._action = (output + self._noise.sample()).clip(-1.0, 1.0).astype(np.float32)
        return self._action

    def store(self, observation: NDArray[np.float32], outcome: Outcome) -> None:
        """Add the transition that ends in `observation`, or begin an episode with it."""
        self._step = outcome.step
        if self._action is None:
            self._replay.begin(observation)
            return
        reward = outcome.reward * self._config.reward_scale
        self._replay.add(self._action, reward, observation, outcome.terminated)

    @property
    def due(self) -> int:
        """Gradient steps to take now: a group of them, where it is time and there is a batch."""
        config = self._config
        is_time = (self._step + 1) % config.update_every == 0
        return config.group_size if is_time and len(self._replay) >= config.batch_size else 0

    @cached_property
    def _group(self) -> tuple[Batch, list[Batch]]:
        """The batches of a group of updates, all in all and one by one."""
        config, problem = self._config, self.problem
        sizes = (config.batch_size, problem.observation_size, problem.action_size)
        drawn = Batch.empty(config.group_size, *sizes, torch.float32)
        return drawn, [drawn.inner(number) for number in range(config.group_size)]

    def update(self) -> Metrics:
        """Take a group of gradient steps where it is time for one."""
        if not self.due:
            return {}
        drawn, batches = self._group
        self.sample(drawn)
        seen = [[float(value) for value in self.networks.update(batch)] for batch in batches]
        return dict(zip(METRICS, np.array(seen).T, strict=True))

    def sample(self, batch: Batch) -> None:
        """Draw the transitions of the next group of updates."""
        self._updates += self._config.group_size
        self._replay.sample(self._replay_generator, batch)

    def policy(self) -> MlpPolicy:
        """Return the actor, on its own memory."""
        return self._policy

    def state_dict(self) -> dict[str, Any]:
        """Return networks, optimisers, replay buffer and random states."""
        return {
            'agent': self.networks.state_dict(),
            'updates': self._updates,
            'replay_generator': self._replay_generator.bit_generator.state,
            'noise_generator': self._noise_generator.bit_generator.state,
            'noise_sigma': self._noise.sigma,
            'replay': self._replay.state(),
        }

    def load_state_dict(self, state: Mapping[str, Any]) -> None:
        """Take over what `state_dict` gave, of a learner with the same configuration."""
        self.networks.load_state_dict(state['agent'])
        self._updates = state.get('updates', 0)  # those of before had no actor that waits
        self._replay_generator.bit_generator.state = state['replay_generator']
        self._noise_generator.bit_generator.state = state['noise_generator']
        self._noise.sigma = state['noise_sigma']
        self._replay.restore(state['replay'])


def policy_of(parameters: ParameterStack) -> MlpPolicy:
    """Make a policy on the memory of the actor of a stack of one."""
    arrays = {name: array[0].numpy() for name, array in parameters.arrays.items()}
    layers = [name.removesuffix('.weight') for name in arrays if name.endswith('.weight')]
    return MlpPolicy(
        tuple((arrays[f'{layer}.weight'], arrays[f'{layer}.bias']) for layer in layers)
    )


def policy_of_before(
    config: LearnerConfig, observation_size: int, action_size: int, state: Mapping[str, Any]
) -> MlpPolicy:
    """Make a policy of the state that files held before they held a policy."""
    assert isinstance(config, DdpgConfig)  # there was no other algorithm
    shapes = Actor.shapes(observation_size, action_size, config.actor.hidden)
    parameters = ParameterStack(shapes)
    parameters.flat.copy_(state['actor'])
    return policy_of(parameters)


def compute_dtype(precision: str) -> torch.dtype | None:
    """Return the dtype of an update's hidden layers; None for that of the master weights."""
    return torch.bfloat16 if precision == 'bfloat16' else None


def _torch_generator(sequence: np.random.SeedSequence) -> torch.Generator:
    """Seed a torch generator from a stream of numpy's."""
    return torch.Generator().manual_seed(int(sequence.generate_state(1, np.uint64)[0]))
