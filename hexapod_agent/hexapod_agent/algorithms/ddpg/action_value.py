# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The critic of an agent with what belongs to it: target and optimiser."""

import torch
from torch import Tensor

from hexapod_agent.algorithms.ddpg.config import CriticConfig
from hexapod_agent.algorithms.ddpg.networks import Critic
from hexapod_agent.algorithms.ddpg.optimizer import ClippedAdam
from hexapod_agent.algorithms.ddpg.parameters import ParameterStack
from hexapod_agent.algorithms.replay import Batch


class ActionValue:
    """A critic, its target and its optimiser.

    Attributes:
        parameters: Online critic.
        target_parameters: What follows it.
        optimizer: Moves the online critic.
        online: The network of the one.
        target: The network of the other.
    """

    def __init__(
        self, observation_size: int, action_size: int, config: CriticConfig, batch_size: int,
        agents: int, dtype: torch.dtype, compute_dtype: torch.dtype | None,
        device: torch.device | str,
    ) -> None:  # fmt: skip
        shapes = Critic.shapes(observation_size, action_size, config.hidden, config.merge)
        self.parameters = ParameterStack(shapes, agents, dtype, device)
        self.target_parameters = self.parameters.like()
        self.optimizer = ClippedAdam(
            self.parameters, config.learning_rate, config.l2, config.gradient_threshold
        )
        gradients = self.optimizer.gradients
        self.online = Critic(self.parameters, batch_size, gradients, compute_dtype)
        self.target = Critic(self.target_parameters, batch_size, None, compute_dtype)

    def learn(self, batch: Batch, target: Tensor) -> Tensor:
        """Take a step towards target values (..., batch, 1); return the loss before it."""
        # L = mean (Q - y)², dL/dQ = 2 (Q - y) / batch
        error = self.online.forward(batch.observation, batch.action).sub_(target)
        loss = torch.linalg.vecdot(error, error, dim=-2) / error.shape[-2]
        error.mul_(2.0 / error.shape[-2])
        self.online.backward(error)
        self.optimizer.step()
        self.online.refresh()
        return loss

    def follow(self, share: float | Tensor) -> None:
        """Move the target by a share of the way to the online critic."""
        self.target_parameters.flat.lerp_(self.parameters.flat, share)
        self.target.refresh()

    def refresh(self) -> None:
        """Let both networks take over parameters that have moved."""
        self.online.refresh()
        self.target.refresh()
