# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Deep deterministic policy gradient for a stack of agents, every gradient written out.

Lillicrap et al. 2016, with the order of operations of MATLAB's DDPG agent: critic, actor, targets.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import torch
from torch import Tensor

from hexapod_agent.algorithms.ddpg.action_value import ActionValue
from hexapod_agent.algorithms.ddpg.config import DdpgConfig
from hexapod_agent.algorithms.ddpg.networks import Actor, initial_bounds
from hexapod_agent.algorithms.ddpg.optimizer import ClippedAdam
from hexapod_agent.algorithms.ddpg.parameters import ParameterStack
from hexapod_agent.algorithms.replay import Batch

METRICS = ('critic_loss', 'actor_loss', 'mean_q')
"""What an update sees: the mean squared temporal difference; -mean Q of the policy's actions, with
the terms that the config adds; mean Q of the policy's actions."""


class Ddpg:
    """Actor, critic, their targets and optimisers.

    Attributes:
        actor_parameters: Online actor.
        critic_parameters: Online critic.

    Args:
        observation_size: Numbers of an observation.
        action_size: Numbers of an action.
        config: Layers and training.
        generator: Draws the initial weights; None leaves them zero, for agents to be `put` in.
        agents: Independent agents that learn side by side.
        dtype: That of master weights, losses and optimisers.
        compute_dtype: That of the hidden layers in an update; `dtype` if None.
        device: Where everything is kept and computed.
    """

    def __init__(
        self,
        observation_size: int,
        action_size: int,
        config: DdpgConfig,
        generator: torch.Generator | None,
        agents: int = 1,
        dtype: torch.dtype = torch.float32,
        compute_dtype: torch.dtype | None = None,
        device: torch.device | str = 'cpu',
    ) -> None:
        sizes = (observation_size, action_size)
        actor, critic, batch_size = config.actor, config.critic, config.ddpg.batch_size
        self._actor_config = actor
        self._target_smoothing = config.ddpg.target_smoothing
        self._smoothing: float | Tensor = self._target_smoothing
        self._single = agents == 1

        self.actor_parameters = ParameterStack(
            Actor.shapes(*sizes, actor.hidden), agents, dtype, device
        )
        self._critic = ActionValue(
            *sizes, critic, batch_size, agents, dtype, compute_dtype, device
        )
        self.critic_parameters = self._critic.parameters
        if generator is not None:
            for parameters in (self.actor_parameters, self.critic_parameters):
                parameters.draw(initial_bounds(parameters.shapes), generator)
            self.critic_parameters.arrays['output.bias'].add_(critic.initial_value)
            self._critic.target_parameters.flat.copy_(self.critic_parameters.flat)
        self._actor_target_parameters = self.actor_parameters.copy()
        self._actor_optimizer = ClippedAdam(
            self.actor_parameters, actor.learning_rate, actor.l2, actor.gradient_threshold
        )

        # Acting computes with the master weights; the updates' hidden layers may not.
        self._policy = Actor(self.actor_parameters, 1)
        gradients = self._actor_optimizer.gradients
        self._actor = Actor(self.actor_parameters, batch_size, gradients, compute_dtype)
        self._target_actor = Actor(self._actor_target_parameters, batch_size, None, compute_dtype)
        if generator is not None:
            self._refresh()

    def _inner(self, tensor: Tensor) -> Tensor:
        """Drop the leading dimension of a stack of one, as the layers expect."""
        return tensor[0] if self._single else tensor

    def act(self, observation: Tensor) -> Tensor:
        """Actions (agents, action size) for inputs (agents, observation size)."""
        action = self._policy.forward(self._inner(observation.unsqueeze(1)))
        return action.view(*observation.shape[:1], -1).clone()

    def update(self, batch: Batch) -> tuple[Tensor, Tensor, Tensor]:
        """Take one gradient step: critic, actor, then both targets; return `METRICS` (agents,).

        Moments of units that no longer fire decay to denormal numbers, on which the optimiser
        takes two thirds longer. They are zero here, and nowhere else: the physics may run in
        the same thread, and must not compute otherwise than in a process of its own.

        Args:
            batch: A batch per agent (agents, batch, ...); for a stack of one (batch, ...).
        """
        torch.set_flush_denormal(True)
        try:
            return self._update(batch)
        finally:
            torch.set_flush_denormal(False)

    def learn_only(self, agents: Sequence[int]) -> None:
        """Let an update leave all other agents of the stack as they are, from now on."""
        for optimizer in self._optimizers().values():
            optimizer.move_only(agents)
        smoothing = torch.zeros(self.actor_parameters.agents, 1)
        smoothing[list(agents)] = self._target_smoothing
        self._smoothing = smoothing.to(self.actor_parameters.flat)

    def set_rate_shares(self, actor: float, critic: float, agent: int = 0) -> None:
        """Let an agent of the stack learn at so much of the learning rates from now on.

        At 0 an actor stays as it is, while its optimiser sees the gradients.
        """
        self._actor_optimizer.set_share(agent, actor)
        self._critic.optimizer.set_share(agent, critic)

    def _update(self, batch: Batch) -> tuple[Tensor, Tensor, Tensor]:
        critic_loss = self._update_critic(batch)
        actor_loss, mean_q = self._update_actor(batch)
        self._critic.follow(self._smoothing)
        self._actor_target_parameters.flat.lerp_(self.actor_parameters.flat, self._smoothing)
        self._target_actor.refresh()
        return critic_loss.view(-1), actor_loss.view(-1), mean_q.view(-1)

    def _update_critic(self, batch: Batch) -> Tensor:
        """Move Q(s, a) towards y = r + bootstrap Q'(s', mu'(s'))."""
        next_action = self._target_actor.forward(batch.next_observation)
        target = self._critic.target.forward(batch.next_observation, next_action)
        torch.addcmul(batch.reward, batch.bootstrap, target, out=target)
        return self._critic.learn(batch, target)

    def _update_actor(self, batch: Batch) -> tuple[Tensor, Tensor]:
        """Move mu(s) up the slope of Q(s, mu(s)) under the critic that was just updated."""
        config = self._actor_config
        action = self._actor.forward(batch.observation)
        critic = self._critic.online
        value = critic.forward(batch.observation, action)
        mean_q, size = value.mean(dim=-2), value.shape[-2]
        # L = -mean Q / n + c mean z², dL/dQ = -1 / (n batch), n = mean |Q| or 1
        magnitude = torch.linalg.vector_norm(value, 1, dim=-2) / size
        scale = magnitude if config.normalize_loss else torch.ones_like(magnitude)
        loss = -mean_q / scale
        penalty = config.preactivation_penalty / (size * action.shape[-1])
        if penalty:
            z = self._actor.preactivation.flatten(-2)
            loss.add_(torch.linalg.vecdot(z, z).unsqueeze(-1), alpha=penalty)
        value.copy_(scale.mul_(-size).reciprocal_().unsqueeze(-2))
        self._actor.backward(critic.action_gradient(value), 2.0 * penalty)
        self._actor_optimizer.step()
        self._actor.refresh()
        return loss, mean_q

    def state_dict(self) -> dict[str, Any]:
        """Networks, targets and optimisers."""
        parts = {name: part.flat for name, part in self._stacks().items()}
        return parts | {name: opt.state_dict() for name, opt in self._optimizers().items()}

    def load_state_dict(self, state: Mapping[str, Any]) -> None:
        """Take over what `state_dict` gave, of networks with the same layers."""
        for name, part in self._stacks().items():
            part.flat.copy_(state[name])
        for name, optimizer in self._optimizers().items():
            optimizer.load_state_dict(state[name])
        self._refresh()

    def put(self, agent: int, single: 'Ddpg') -> None:
        """Take over a stack of one, of the same layers, as an agent of this stack.

        Its observations may be smaller than this stack's, which are then to be filled with zeros.
        """
        for mine, its in zip(self._stacks().values(), single._stacks().values(), strict=True):
            mine.put(agent, its)
        optimizers = zip(self._optimizers().values(), single._optimizers().values(), strict=True)
        for ours, theirs in optimizers:
            ours.put(agent, theirs)
        self._refresh()

    def take(self, agent: int, single: 'Ddpg') -> None:
        """Write an agent of this stack to a stack of one: the inverse of `put`."""
        for mine, its in zip(self._stacks().values(), single._stacks().values(), strict=True):
            mine.take(agent, its)
        optimizers = zip(self._optimizers().values(), single._optimizers().values(), strict=True)
        for ours, theirs in optimizers:
            ours.take(agent, theirs)
        single._refresh()

    def _refresh(self) -> None:
        """Let the updates' networks take over parameters that have moved."""
        self._actor.refresh()
        self._target_actor.refresh()
        self._critic.refresh()

    def _stacks(self) -> dict[str, ParameterStack]:
        return {
            'actor': self.actor_parameters,
            'target_actor': self._actor_target_parameters,
            'critic': self.critic_parameters,
            'target_critic': self._critic.target_parameters,
        }

    def _optimizers(self) -> dict[str, ClippedAdam]:
        return {
            'actor_optimizer': self._actor_optimizer,
            'critic_optimizer': self._critic.optimizer,
        }
