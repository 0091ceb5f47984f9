# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""TD3: DDPG with two critics, a delayed actor and noise on the target's action."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from stable_baselines3 import TD3
from torch import Tensor

from hexapod_agent.algorithms.learner import Metrics, Problem
from hexapod_agent.algorithms.noise import OrnsteinUhlenbeckNoise
from hexapod_agent.algorithms.policies import MlpPolicy
from hexapod_agent.algorithms.stable_baselines.config import Td3Config
from hexapod_agent.algorithms.stable_baselines.model import policy_of
from hexapod_agent.algorithms.stable_baselines.off_policy import OffPolicyLearner
from hexapod_agent.algorithms.update_groups import group_size


class Td3Learner(OffPolicyLearner):
    """See `OffPolicyLearner`."""

    metric_names = ('critic_loss', 'actor_loss', 'mean_q')
    logged = {'critic_loss': 'train/critic_loss', 'actor_loss': 'train/actor_loss'}  # noqa: RUF012
    model: TD3

    def __init__(self, config: Td3Config, problem: Problem, seed: int) -> None:
        config.check_training(problem.episode_steps)
        self._td3 = config.td3
        super().__init__(config.td3, group_size('td3', config.td3), problem, seed)
        self._noise = OrnsteinUhlenbeckNoise(
            config.noise, problem.action_size, problem.period_s, self.exploration
        )

    def new_model(self, problem: Problem) -> TD3:
        """Return the library's TD3; the noise on the target is of `prepare`."""
        delay = self._td3.policy_delay
        return TD3(**self.arguments(), policy_delay=delay, target_policy_noise=0.0)

    def prepare(self, generator: torch.Generator) -> MlpPolicy:
        """Put clipped noise on the target's action, as the library would of torch's generator."""
        limit, deviation = self._td3.target_noise_limit, self._td3.target_noise

        def smooth(module: Any, inputs: Any, action: Tensor) -> Tensor:
            noise = torch.empty_like(action).normal_(0.0, deviation, generator=generator)
            return action + noise.clamp_(-limit, limit)

        self.model.actor_target.register_forward_hook(smooth)
        return policy_of(self.model.actor.mu)

    def begin_episode(self, rate_share: float) -> None:
        """Begin an episode, with the noise at its mean."""
        super().begin_episode(rate_share)
        self._noise.reset()

    def explored(self, features: NDArray[np.float32]) -> NDArray[np.float32]:
        """Return the policy's action with Ornstein-Uhlenbeck noise."""
        return (self.output + self._noise.sample()).clip(-1.0, 1.0).astype(np.float32)

    def update(self) -> Metrics:
        """Take a group of gradient steps; what the actor maximises is the value of its actions."""
        seen = super().update()
        return {**seen, 'mean_q': -seen['actor_loss']} if 'actor_loss' in seen else seen

    def state_dict(self) -> dict[str, Any]:
        """Return networks, optimisers, replay buffer and random states."""
        return super().state_dict() | {'noise_sigma': self._noise.sigma}

    def load_state_dict(self, state: Mapping[str, Any]) -> None:
        """Take over what `state_dict` gave, of a learner with the same configuration."""
        super().load_state_dict(state)
        self._noise.sigma = state['noise_sigma']
