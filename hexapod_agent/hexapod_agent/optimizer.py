# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Gradient step of one network as MATLAB's trainer takes it: clip each array, then Adam.

The L2 term is already part of the gradient (`layers.Dense.backward`), so that the norm which is
compared with the threshold includes it.
"""

from copy import deepcopy
from typing import Any

import torch

from hexapod_agent.parameters import ParameterStack


class ClippedAdam:
    """Adam behind a threshold on the L2 norm of each array's gradient, for each agent apart.

    Attributes:
        gradients: Stack to fill before `step`.

    Args:
        parameters: What is optimised.
        learning_rate: Adam's step size.
        threshold: Largest norm of an array's gradient; a longer one is scaled down to it.
    """

    def __init__(self, parameters: ParameterStack, learning_rate: float, threshold: float) -> None:
        self.gradients = parameters.like()
        self._threshold = threshold
        parameter = torch.nn.Parameter(parameters.flat, requires_grad=False)
        parameter.grad = self.gradients.flat
        self._adam = torch.optim.Adam([parameter], lr=learning_rate, fused=True)

    def step(self) -> None:
        """Clip the gradients in place and move the parameters."""
        for array in self.gradients.arrays.values():
            dims = tuple(range(1, array.ndim))
            norm = torch.linalg.vector_norm(array, dim=dims, keepdim=True)
            array.mul_(self._threshold / norm.clamp_(min=self._threshold))
        self._adam.step()

    def state_dict(self) -> dict[str, Any]:
        """Moments and step count."""
        return self._adam.state_dict()

    def load_state_dict(self, state: dict[str, Any]) -> None:
        """Take over a copy of what `state_dict` gave."""
        self._adam.load_state_dict(deepcopy(state))
