# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Gradient step of one network as MATLAB's trainer takes it: L2 term, clipping, Adam."""

from collections.abc import Sequence

import torch
from torch import Tensor

from hexapod_agent.algorithms.ddpg.parameters import ParameterStack
from hexapod_agent.compat import fused_adam


class ClippedAdam:
    """Adam behind a threshold on the L2 norm of each array's gradient, for each agent apart.

    The L2 term l2 W is added to the gradients of weights before their norms are taken.

    Attributes:
        gradients: Stack to fill before `step`.

    Args:
        parameters: What is optimised.
        learning_rate: Adam's step size.
        l2: Factor of the L2 term.
        threshold: Largest norm of an array's gradient; a longer one is scaled down to it.
    """

    def __init__(
        self, parameters: ParameterStack, learning_rate: float, l2: float, threshold: float
    ) -> None:
        self.gradients = parameters.like()
        self._learning_rate = learning_rate
        self._shares = [1.0] * parameters.agents
        self._l2 = l2
        self._threshold = threshold
        self._flat = parameters.flat
        self._weights = parameters.flat_weights
        self._weight_gradients = self.gradients.flat_weights
        arrays = self.gradients.arrays.values()
        self._norms = self._flat.new_zeros(len(arrays), parameters.agents)
        self._clipped = [
            (array, tuple(range(1, array.ndim)), norm.view(-1, *[1] * (array.ndim - 1)))
            for array, norm in zip(arrays, self._norms, strict=True)
        ]
        self._mean, self._square = parameters.like(), parameters.like()
        # Agents that began at different times are at different steps.
        self._steps = self._flat.new_zeros(parameters.agents, dtype=torch.float32)
        self.move_only(range(parameters.agents))

    def move_only(self, agents: Sequence[int]) -> None:
        """Leave the parameters of all other agents alone from now on."""
        self._agents = list(agents)
        self._moved = self._rows(agents)
        self._moving = torch.zeros_like(self._steps)
        self._moving[self._agents] = 1.0

    def set_share(self, agent: int, share: float) -> None:
        """Let an agent step by so much of the learning rate from now on."""
        self._shares[agent] = share

    def _rows(self, agents: Sequence[int]) -> list[list[Tensor]]:
        """Parameters, gradients, moments and step counts, a view per agent."""
        stacks = (self._flat, self.gradients.flat, self._mean.flat, self._square.flat)
        return [[stack[agent] for agent in agents] for stack in (*stacks, self._steps)]

    def step(self) -> None:
        """Regularise and clip the gradients in place, and move the parameters."""
        self._weight_gradients.add_(self._weights, alpha=self._l2)
        for array, dims, norm in self._clipped:
            torch.linalg.vector_norm(array, dim=dims, keepdim=True, out=norm)
        # scale = threshold / max(norm, threshold)
        self._norms.clamp_(min=self._threshold).reciprocal_().mul_(self._threshold)
        for array, _, scale in self._clipped:
            array.mul_(scale)
        self._steps.add_(self._moving)
        shares = [self._shares[agent] for agent in self._agents]
        if len(set(shares)) == 1:
            fused_adam(self._moved, shares[0] * self._learning_rate)
            return
        for place, share in enumerate(shares):
            rows = [each[place : place + 1] for each in self._moved]
            fused_adam(rows, share * self._learning_rate)

    def put(self, agent: int, single: 'ClippedAdam') -> None:
        """Take over the state of a stack of one as an agent of this stack."""
        self._mean.put(agent, single._mean)
        self._square.put(agent, single._square)
        self._steps[agent] = single._steps[0]

    def take(self, agent: int, single: 'ClippedAdam') -> None:
        """Write the state of an agent of this stack to a stack of one."""
        self._mean.take(agent, single._mean)
        self._square.take(agent, single._square)
        single._steps[0] = self._steps[agent]

    def state_dict(self) -> dict[str, Tensor]:
        """Moments and step count."""
        steps = self._steps[0] if len(self._steps) == 1 else self._steps
        return {'mean': self._mean.flat, 'square': self._square.flat, 'steps': steps}

    def load_state_dict(self, state: dict[str, Tensor]) -> None:
        """Take over what `state_dict` gave."""
        for name, value in self.state_dict().items():
            value.copy_(state[name])
