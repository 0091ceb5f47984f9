# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""SAC: a policy with a spread that is rewarded for it, at a temperature that is learned."""

import math
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from stable_baselines3 import SAC
from stable_baselines3.common.distributions import SquashedDiagGaussianDistribution
from stable_baselines3.sac.policies import LOG_STD_MAX, LOG_STD_MIN
from torch import Tensor, nn

from hexapod_agent.algorithms.learner import Problem
from hexapod_agent.algorithms.policies import MlpPolicy
from hexapod_agent.algorithms.stable_baselines.config import SacConfig
from hexapod_agent.algorithms.stable_baselines.model import fill_bias, layers_of, policy_of
from hexapod_agent.algorithms.stable_baselines.off_policy import OffPolicyLearner
from hexapod_agent.algorithms.update_groups import group_size


class SeededGaussian(SquashedDiagGaussianDistribution):
    """The library's distribution of actions, drawn from a generator of one's own."""

    def __init__(self, action_size: int, generator: torch.Generator) -> None:
        super().__init__(action_size)
        self._generator = generator

    def sample(self) -> Tensor:
        """Draw actions, in a way that passes gradients."""
        spread = self.distribution
        drawn = torch.randn(spread.mean.shape, generator=self._generator)
        self.gaussian_actions = spread.mean + spread.stddev * drawn
        return torch.tanh(self.gaussian_actions)


class SacLearner(OffPolicyLearner):
    """See `OffPolicyLearner`."""

    metric_names = ('critic_loss', 'actor_loss', 'temperature', 'temperature_loss')
    logged = {  # noqa: RUF012
        'critic_loss': 'train/critic_loss',
        'actor_loss': 'train/actor_loss',
        'temperature': 'train/ent_coef',
        'temperature_loss': 'train/ent_coef_loss',
    }
    model: SAC
    _spread: tuple[NDArray[np.float32], NDArray[np.float32]]
    """Weight and bias of the layer that gives the logarithm of the deviation."""

    def __init__(self, config: SacConfig, problem: Problem, seed: int) -> None:
        config.check_training(problem.episode_steps)
        self._sac = config.sac
        super().__init__(config.sac, group_size('sac', config.sac), problem, seed)

    def new_model(self, problem: Problem) -> SAC:
        """Return the library's SAC."""
        return SAC(
            **self.arguments(),
            ent_coef=f'auto_{self._sac.temperature}',
            target_entropy=self._sac.target_entropy * problem.action_size,
        )

    def prepare(self, generator: torch.Generator) -> MlpPolicy:
        """Let the updates draw their actions from a generator; the policy is tanh of the mean."""
        actor = self.model.actor
        spread: Any = SeededGaussian(actor.action_dist.action_dim, generator)
        actor.action_dist = spread
        assert isinstance(actor.log_std, nn.Module)
        fill_bias(actor.log_std, math.log(self._sac.deviation))
        self._spread = layers_of(actor.log_std)[0]
        return policy_of(actor.latent_pi, actor.mu)

    def explored(self, features: NDArray[np.float32]) -> NDArray[np.float32]:
        """Return an action drawn from the policy."""
        weight, bias = self._spread
        log_deviation = (weight @ features + bias).clip(LOG_STD_MIN, LOG_STD_MAX)
        drawn = self.exploration.standard_normal(log_deviation.size, dtype=np.float32)
        outputs = self._policy.outputs(features)
        return self._policy.bounded(outputs + np.exp(log_deviation) * drawn)
