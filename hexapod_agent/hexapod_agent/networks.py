# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Actor and critic of the article, forward and backward written out over preallocated buffers.

Written out, the actor step computes only what its formula needs: no gradient of the critic's
weights and none through the critic's observation branch. Tests hold it against autograd.
Tensors have the shapes that `layers` tells.
"""

import math
from collections.abc import Mapping, Sequence
from itertools import pairwise

import torch
from torch import Tensor

from hexapod_agent.layers import Dense, layer_shapes, relu_backward
from hexapod_agent.parameters import ParameterStack

OUTPUT_BOUND = 5e-3  # of the output layers' initial weights
MERGES = ('add', 'append')


def initial_bounds(shapes: Mapping[str, tuple[int, ...]]) -> dict[str, float]:
    """Bound of each array's uniform initial distribution: 1/sqrt(fan in), output layer 5e-3."""
    fan_in = {name.split('.')[0]: s[1] for name, s in shapes.items() if name.endswith('.weight')}
    layers = {name: name.split('.')[0] for name in shapes}
    return {
        name: OUTPUT_BOUND if layer == 'output' else 1.0 / math.sqrt(fan_in[layer])
        for name, layer in layers.items()
    }


class Actor:
    """Policy mu(s) = tanh(z): observation, hidden ReLU layers, one tanh output per action.

    Args:
        parameters: Layout of `Actor.shapes`.
        batch: Observations per pass.
        gradients: Filled by `backward`; None for a pass that never goes back.
    """

    @staticmethod
    def shapes(
        observation_size: int, action_size: int, hidden: Sequence[int]
    ) -> dict[str, tuple[int, ...]]:
        """Names and shapes of the arrays, in the order of the flat tensor."""
        shapes: dict[str, tuple[int, ...]] = {}
        for index, (inputs, outputs) in enumerate(pairwise([observation_size, *hidden])):
            shapes |= layer_shapes(f'hidden{index}', inputs, outputs)
        return shapes | layer_shapes('output', hidden[-1], action_size)

    def __init__(
        self, parameters: ParameterStack, batch: int, gradients: ParameterStack | None = None,
    ) -> None:  # fmt: skip
        self._layers = [
            Dense(parameters, gradients, name.removesuffix('.weight'), batch)
            for name in parameters.shapes
            if name.endswith('.weight')
        ]
        self.preactivation = self._layers[-1].output
        self.action = torch.empty_like(self.preactivation)
        self._slope = torch.empty_like(self.preactivation)

    def forward(self, observation: Tensor) -> Tensor:
        """Actions of a batch, in the buffer `action`; `preactivation` holds them before tanh."""
        x = observation
        for layer in self._layers[:-1]:
            x = torch.relu_(layer.forward(x))
        self._layers[-1].forward(x)
        return torch.tanh(self.preactivation, out=self.action)

    def backward(
        self, observation: Tensor, action_gradient: Tensor, preactivation_factor: float
    ) -> None:
        """Fill the gradients of the pass that `forward` made.

        Args:
            observation: The batch given to `forward`.
            action_gradient: Gradient of the loss with respect to the actions; overwritten.
            preactivation_factor: c of a further term c/2 sum(z²) of the loss.
        """
        # dz = da (1 - tanh² z) + c z
        torch.mul(self.action, self.action, out=self._slope)
        gradient = torch.addcmul(
            action_gradient, action_gradient, self._slope, value=-1.0, out=action_gradient
        )
        gradient.add_(self.preactivation, alpha=preactivation_factor)
        for below, layer in zip(self._layers[-2::-1], self._layers[:0:-1], strict=True):
            layer.backward(below.output, gradient)
            gradient = relu_backward(layer.backward_input(gradient), below.output)
        self._layers[0].backward(observation, gradient)


class Critic:
    """Action value Q(s, a): a branch per input, merged, ReLU, one linear output.

    `add` sums the branches before the ReLU, which couples state and action. `append` puts them
    side by side; then Q = f(s) + g(a), and its action gradient does not depend on the state.

    Args:
        parameters: Layout of `Critic.shapes`; tells which merge it is.
        batch: Pairs of observation and action per pass.
        gradients: Filled by `backward`; None for a pass that never goes back.
    """

    @staticmethod
    def shapes(
        observation_size: int, action_size: int, hidden: Sequence[int], merge: str = 'add'
    ) -> dict[str, tuple[int, ...]]:
        """Names and shapes of the arrays, in the order of the flat tensor."""
        shapes: dict[str, tuple[int, ...]] = {}
        for index, (inputs, outputs) in enumerate(pairwise([observation_size, *hidden])):
            shapes |= layer_shapes(f'observation{index}', inputs, outputs)
        shapes |= layer_shapes('action', action_size, hidden[-1])
        merged = hidden[-1] * (2 if merge == 'append' else 1)
        return shapes | layer_shapes('output', merged, 1)

    def __init__(
        self, parameters: ParameterStack, batch: int, gradients: ParameterStack | None = None,
    ) -> None:  # fmt: skip
        self._observation = [
            Dense(parameters, gradients, name.removesuffix('.weight'), batch)
            for name in parameters.shapes
            if name.startswith('observation') and name.endswith('.weight')
        ]
        self._action = Dense(parameters, gradients, 'action', batch)
        self._output = Dense(parameters, gradients, 'output', batch)
        width = self._action.output.shape[-1]
        self._append = self._output.weight.shape[-1] == 2 * width
        shape = (*self._action.output.shape[:-1], self._output.weight.shape[-1])
        self._merged = self._action.output.new_empty(shape)
        self._observation_part = slice(0, width)
        self._action_part = slice(width, 2 * width) if self._append else slice(0, width)
        self.value = self._output.output

    def forward(self, observation: Tensor, action: Tensor) -> Tensor:
        """Values (..., batch, 1) in the buffer `value`."""
        x = observation
        for layer in self._observation[:-1]:
            x = torch.relu_(layer.forward(x))
        last = self._observation[-1]
        if self._append:
            self._merged[..., self._observation_part] = last.forward(x)
            self._merged[..., self._action_part] = self._action.forward(action)
        else:
            self._action.add_to(last.forward(x, out=self._merged), action)
        torch.relu_(self._merged)
        return self._output.forward(self._merged)

    def backward(self, observation: Tensor, action: Tensor, value_gradient: Tensor) -> None:
        """Fill the gradients of the pass that `forward` made, given dL/dQ (..., batch, 1)."""
        self._output.backward(self._merged, value_gradient)
        merged = self._merged_gradient(value_gradient)
        self._action.backward(action, merged[..., self._action_part])
        gradient = merged[..., self._observation_part]
        for below, layer in zip(self._observation[-2::-1], self._observation[:0:-1], strict=True):
            layer.backward(below.output, gradient)
            gradient = relu_backward(layer.backward_input(gradient), below.output)
        self._observation[0].backward(observation, gradient)

    def action_gradient(self, value_gradient: Tensor) -> Tensor:
        """Gradient with respect to the actions of the last `forward`, in a buffer."""
        merged = self._merged_gradient(value_gradient)
        return self._action.backward_input(merged[..., self._action_part])

    def _merged_gradient(self, value_gradient: Tensor) -> Tensor:
        """Gradient before the ReLU that follows the merge."""
        return relu_backward(self._output.backward_input(value_gradient), self._merged)
