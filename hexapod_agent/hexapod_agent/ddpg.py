# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Deep deterministic policy gradient for a stack of agents, every gradient written out.

Lillicrap et al. 2016, with the order of operations of MATLAB's DDPG agent: critic, actor, targets.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import torch
from torch import Tensor

from hexapod_agent.hyperparameters import ActorConfig, CriticConfig
from hexapod_agent.networks import Actor, Critic, initial_bounds
from hexapod_agent.optimizer import ClippedAdam
from hexapod_agent.parameters import ParameterStack
from hexapod_agent.replay import Batch


@dataclass(frozen=True)
class UpdateStatistics:
    """What one update saw, each of shape (agents,).

    Attributes:
        critic_loss: Mean squared temporal difference.
        actor_loss: -mean Q of the policy's actions, with the terms that the config adds.
        mean_q: Mean Q of the policy's actions.
    """

    critic_loss: Tensor
    actor_loss: Tensor
    mean_q: Tensor


class Ddpg:
    """Actor, critic, their targets and optimisers.

    Attributes:
        actor_parameters: Online actor.
        critic_parameters: Online critic.

    Args:
        observation_size: Numbers of an observation.
        action_size: Numbers of an action.
        actor: The policy and its training.
        critic: The action value and its training.
        batch_size: Transitions per update.
        target_smoothing: Share of the online network that moves into its target per update.
        generator: Draws the initial weights; None leaves them zero, for agents to be `put` in.
        agents: Independent agents that learn side by side.
        dtype: Number format of parameters, losses and optimisers.
        hidden_dtype: Number format of the hidden layers in an update; `dtype` if None.
        device: Where everything is kept and computed.
    """

    def __init__(
        self,
        observation_size: int,
        action_size: int,
        actor: ActorConfig,
        critic: CriticConfig,
        batch_size: int,
        target_smoothing: float,
        generator: torch.Generator | None,
        agents: int = 1,
        dtype: torch.dtype = torch.float32,
        hidden_dtype: torch.dtype | None = None,
        device: torch.device | str = 'cpu',
    ) -> None:
        sizes = (observation_size, action_size)
        self._actor_config = actor
        self._target_smoothing = target_smoothing
        self._smoothing: float | Tensor = target_smoothing
        self._single = agents == 1

        self.actor_parameters = ParameterStack(
            Actor.shapes(*sizes, actor.hidden), agents, dtype, device
        )
        self.critic_parameters = ParameterStack(
            Critic.shapes(*sizes, critic.hidden, critic.merge), agents, dtype, device
        )
        if generator is not None:
            for parameters in (self.actor_parameters, self.critic_parameters):
                parameters.draw(initial_bounds(parameters.shapes), generator)
            self.critic_parameters.arrays['output.bias'].add_(critic.initial_value)
        self._actor_target_parameters = self.actor_parameters.copy()
        self._critic_target_parameters = self.critic_parameters.copy()
        self._actor_optimizer = ClippedAdam(
            self.actor_parameters, actor.learning_rate, actor.l2, actor.gradient_threshold
        )
        self._critic_optimizer = ClippedAdam(
            self.critic_parameters, critic.learning_rate, critic.l2, critic.gradient_threshold
        )

        # Acting stays in the full format; the updates' hidden layers may not.
        self._policy = Actor(self.actor_parameters, 1)
        actor_gradients = self._actor_optimizer.gradients
        critic_gradients = self._critic_optimizer.gradients
        self._actor = Actor(self.actor_parameters, batch_size, actor_gradients, hidden_dtype)
        self._critic = Critic(self.critic_parameters, batch_size, critic_gradients, hidden_dtype)
        self._target_actor = Actor(self._actor_target_parameters, batch_size, None, hidden_dtype)
        self._target_critic = Critic(
            self._critic_target_parameters, batch_size, None, hidden_dtype
        )

    def _inner(self, tensor: Tensor) -> Tensor:
        """Drop the leading dimension of a stack of one, as the layers expect."""
        return tensor[0] if self._single else tensor

    def act(self, observation: Tensor) -> Tensor:
        """Actions (agents, action size) for observations (agents, observation size)."""
        action = self._policy.forward(self._inner(observation.unsqueeze(1)))
        return action.view(*observation.shape[:1], -1).clone()

    def update(self, batch: Batch) -> UpdateStatistics:
        """Take one gradient step: critic, actor, then both targets.

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
        for optimizer in (self._actor_optimizer, self._critic_optimizer):
            optimizer.move_only(agents)
        smoothing = torch.zeros(self.actor_parameters.agents, 1)
        smoothing[list(agents)] = self._target_smoothing
        self._smoothing = smoothing.to(self.actor_parameters.flat)

    def _update(self, batch: Batch) -> UpdateStatistics:
        critic_loss = self._update_critic(batch)
        actor_loss, mean_q = self._update_actor(batch)
        for target, online in (
            (self._critic_target_parameters, self.critic_parameters),
            (self._actor_target_parameters, self.actor_parameters),
        ):
            target.flat.lerp_(online.flat, self._smoothing)
        self._target_actor.refresh()
        self._target_critic.refresh()
        return UpdateStatistics(critic_loss.view(-1), actor_loss.view(-1), mean_q.view(-1))

    def _update_critic(self, batch: Batch) -> Tensor:
        """Move Q(s, a) towards y = r + bootstrap Q'(s', mu'(s'))."""
        next_action = self._target_actor.forward(batch.next_observation)
        target = self._target_critic.forward(batch.next_observation, next_action)
        torch.addcmul(batch.reward, batch.bootstrap, target, out=target)
        # L = mean (Q - y)², dL/dQ = 2 (Q - y) / batch
        error = self._critic.forward(batch.observation, batch.action).sub_(target)
        loss = torch.linalg.vecdot(error, error, dim=-2) / error.shape[-2]
        error.mul_(2.0 / error.shape[-2])
        self._critic.backward(error)
        self._critic_optimizer.step()
        self._critic.refresh()
        return loss

    def _update_actor(self, batch: Batch) -> tuple[Tensor, Tensor]:
        """Move mu(s) up the slope of Q(s, mu(s)) under the critic that was just updated."""
        config = self._actor_config
        action = self._actor.forward(batch.observation)
        value = self._critic.forward(batch.observation, action)
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
        self._actor.backward(self._critic.action_gradient(value), 2.0 * penalty)
        self._actor_optimizer.step()
        self._actor.refresh()
        return loss, mean_q

    def state_dict(self) -> dict[str, Any]:
        """Networks, targets and optimisers."""
        return {name: part.flat for name, part in self._stacks().items()} | {
            'actor_optimizer': self._actor_optimizer.state_dict(),
            'critic_optimizer': self._critic_optimizer.state_dict(),
        }

    def acting_state(self) -> dict[str, Any]:
        """The actor alone."""
        return {'actor': self.actor_parameters.flat}

    def load_state_dict(self, state: dict[str, Any]) -> None:
        """Take over what `state_dict` or `acting_state` gave, of networks with the same layers."""
        for name, part in self._stacks().items():
            if name in state:
                part.flat.copy_(state[name])
        if 'actor_optimizer' in state:
            self._actor_optimizer.load_state_dict(state['actor_optimizer'])
            self._critic_optimizer.load_state_dict(state['critic_optimizer'])
        self._refresh()

    def put(self, agent: int, single: 'Ddpg') -> None:
        """Take over a stack of one, of the same layers, as an agent of this stack.

        Its observations may be smaller than this stack's, which are then to be filled with zeros.
        """
        for mine, its in zip(self._stacks().values(), single._stacks().values(), strict=True):
            mine.put(agent, its)
        self._actor_optimizer.put(agent, single._actor_optimizer)
        self._critic_optimizer.put(agent, single._critic_optimizer)
        self._refresh()

    def take(self, agent: int, single: 'Ddpg') -> None:
        """Write an agent of this stack to a stack of one: the inverse of `put`."""
        for mine, its in zip(self._stacks().values(), single._stacks().values(), strict=True):
            mine.take(agent, its)
        self._actor_optimizer.take(agent, single._actor_optimizer)
        self._critic_optimizer.take(agent, single._critic_optimizer)
        single._refresh()

    def _refresh(self) -> None:
        """Let the updates' networks take over parameters that have moved."""
        for network in (self._actor, self._critic, self._target_actor, self._target_critic):
            network.refresh()

    def _stacks(self) -> dict[str, ParameterStack]:
        return {
            'actor': self.actor_parameters,
            'critic': self.critic_parameters,
            'target_actor': self._actor_target_parameters,
            'target_critic': self._critic_target_parameters,
        }
