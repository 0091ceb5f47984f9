# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The article's DDPG as a textbook writes it, by autograd: what `Ddpg` computes, to be read.

Lillicrap et al. 2016, with the order of operations of MATLAB's DDPG agent. Tests hold `Ddpg`,
which writes the gradients out, to this.
"""

from collections.abc import Mapping

import torch
from hexapod_agent.algorithms.ddpg.config import ActorConfig, CriticConfig, DdpgConfig
from hexapod_agent.algorithms.replay import Batch
from torch import Tensor

Arrays = dict[str, Tensor]
"""Weights '<layer>.weight' (outputs, inputs) and biases '<layer>.bias' (outputs,)."""


def affine(arrays: Arrays, layer: str, x: Tensor) -> Tensor:
    """Return x Wᵀ + b."""
    return x @ arrays[f'{layer}.weight'].T + arrays[f'{layer}.bias']


def preactivation(arrays: Arrays, config: ActorConfig, observation: Tensor) -> Tensor:
    """Return z, of which the policy is mu(s) = tanh z."""
    x = observation
    for number in range(len(config.hidden)):
        x = affine(arrays, f'hidden{number}', x).relu()
    return affine(arrays, 'output', x)


def action_value(
    arrays: Arrays, config: CriticConfig, observation: Tensor, action: Tensor
) -> Tensor:
    """Return Q(s, a): a branch for each input, merged, ReLU, one linear output."""
    x = observation
    *below, last = range(len(config.hidden))
    for number in below:
        x = affine(arrays, f'observation{number}', x).relu()
    branches = affine(arrays, f'observation{last}', x), affine(arrays, 'action', action)
    merged = branches[0] + branches[1] if config.merge == 'add' else torch.cat(branches, dim=-1)
    return affine(arrays, 'output', merged.relu())


class ClippedStep:
    """Adam behind an L2 term on weights and a threshold on the norm of each array's gradient."""

    def __init__(self, arrays: Arrays, config: ActorConfig | CriticConfig) -> None:
        self._arrays, self._config = arrays, config
        self._optimizer = torch.optim.Adam(arrays.values(), lr=config.learning_rate)

    def take(self, loss: Tensor) -> None:
        """Move the arrays down the slope of a loss."""
        self._optimizer.zero_grad()
        loss.backward()
        for name, array in self._arrays.items():
            assert array.grad is not None
            if name.endswith('.weight'):
                array.grad.add_(array.detach(), alpha=self._config.l2)
            threshold = self._config.gradient_threshold
            array.grad.mul_(threshold / array.grad.norm().clamp(min=threshold))
        self._optimizer.step()


class ReferenceDdpg:
    """Actor, critic and targets of one agent.

    Attributes:
        networks: Arrays by network, actor and critic.
        targets: The same of the networks that follow them.
    """

    def __init__(
        self,
        config: DdpgConfig,
        networks: Mapping[str, Arrays],
        targets: Mapping[str, Arrays],
    ) -> None:
        """Begin with copies of such networks, which have had no update."""
        self._actor, self._critic = config.actor, config.critic
        self._smoothing = config.ddpg.target_smoothing
        self.networks = {name: _copied(arrays, learned=True) for name, arrays in networks.items()}
        self.targets = {name: _copied(arrays, learned=False) for name, arrays in targets.items()}
        self._steps = {
            name: ClippedStep(arrays, config.actor if name == 'actor' else config.critic)
            for name, arrays in self.networks.items()
        }

    def update(self, batch: Batch) -> tuple[float, float, float]:
        """Take one gradient step from a batch (batch, ...); return what `METRICS` names."""
        critic_loss = self._update_critic(batch)
        actor_loss, mean_q = self._update_actor(batch.observation)
        for name, target in self.targets.items():
            for key, array in target.items():
                array.lerp_(self.networks[name][key].detach(), self._smoothing)
        return critic_loss, actor_loss, mean_q

    def _update_critic(self, batch: Batch) -> float:
        """Move Q(s, a) towards y = r + bootstrap Q'(s', mu'(s'))."""
        with torch.no_grad():
            following = batch.next_observation
            action = preactivation(self.targets['actor'], self._actor, following).tanh()
            value = action_value(self.targets['critic'], self._critic, following, action)
            wanted = batch.reward + batch.bootstrap * value
        arrays = self.networks['critic']
        value = action_value(arrays, self._critic, batch.observation, batch.action)
        loss = (value - wanted).square().mean()
        self._steps['critic'].take(loss)
        return loss.item()

    def _update_actor(self, observation: Tensor) -> tuple[float, float]:
        """Move mu(s) up the slope of Q(s, mu(s)) under the critic that was just updated."""
        config = self._actor
        frozen = {name: array.detach() for name, array in self.networks['critic'].items()}
        z = preactivation(self.networks['actor'], config, observation)
        value = action_value(frozen, self._critic, observation, z.tanh())
        scale = value.detach().abs().mean() if config.normalize_loss else 1.0
        loss = -value.mean() / scale + config.preactivation_penalty * z.square().mean()
        self._steps['actor'].take(loss)
        return loss.item(), value.mean().item()


def _copied(arrays: Arrays, learned: bool) -> Arrays:
    return {name: array.detach().clone().requires_grad_(learned) for name, array in arrays.items()}
