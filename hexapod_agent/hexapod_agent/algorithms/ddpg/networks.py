# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Actor and critic of the article, forward and backward written out over preallocated buffers.

Written out, the actor step computes only what its formula needs: no gradient of the critic's
weights and none through the critic's observation branch. Tests hold it against autograd.
Tensors have the shapes that `layers` tells. Hidden layers may compute in another dtype than that
of the master weights; output layers, what they get and what they give keep the latter.
"""

import math
from collections.abc import Mapping, Sequence
from itertools import pairwise

import torch
from torch import Tensor

from hexapod_agent.algorithms.ddpg.layers import (
    Cast,
    ComputeCopy,
    Dense,
    SingleUnit,
    layer_shapes,
)
from hexapod_agent.algorithms.ddpg.parameters import ParameterStack
from hexapod_agent.compat import relu_backward

OUTPUT_BOUND = 5e-3  # of the output layers' initial weights


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
        dtype: Compute dtype of the hidden layers; that of the parameters if None.
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
        self,
        parameters: ParameterStack,
        batch: int,
        gradients: ParameterStack | None = None,
        dtype: torch.dtype | None = None,
    ) -> None:
        master = parameters.flat.dtype
        compute = dtype or master
        self._copy = copy = ComputeCopy(parameters, gradients, compute)
        self._hidden = _branch(copy, 'hidden', batch)
        self._output = Dense(parameters, gradients, 'output', batch)
        last = self._hidden[-1].output
        self._to_master = Cast(last, master)
        self._to_compute = Cast(last.to(master), compute)
        first = self._hidden[0]
        self._input_to_compute = Cast(first.input_like(master), compute)
        self.preactivation = self._output.output
        self.action = torch.empty_like(self.preactivation)
        self._slope = torch.empty_like(self.preactivation)

    def refresh(self) -> None:
        """Take over parameters that have moved."""
        self._copy.refresh()

    def forward(self, observation: Tensor) -> Tensor:
        """Actions of a batch, in the buffer `action`; `preactivation` holds them before tanh."""
        self._x = x = self._input_to_compute(observation)
        for layer in self._hidden:
            x = torch.relu_(layer.forward(x))
        self._features = self._to_master(x)
        self._output.forward(self._features)
        return torch.tanh(self.preactivation, out=self.action)

    def backward(self, action_gradient: Tensor, preactivation_factor: float) -> None:
        """Fill the gradients of the last `forward`.

        Args:
            action_gradient: Gradient of the loss with respect to the actions; overwritten.
            preactivation_factor: c of a further term c/2 sum(z²) of the loss.
        """
        # dz = da (1 - tanh² z) + c z
        torch.mul(self.action, self.action, out=self._slope)
        gradient = torch.addcmul(
            action_gradient, action_gradient, self._slope, value=-1.0, out=action_gradient
        )
        gradient.add_(self.preactivation, alpha=preactivation_factor)
        hidden = self._to_compute(self._output.backward_input(gradient))
        gradient_in = relu_backward(hidden, self._hidden[-1].output)
        _branch_backward(self._hidden, self._x, gradient_in)
        self._copy.pass_gradients_on()
        self._output.backward(self._features, gradient)


class Critic:
    """Action value Q(s, a): a branch per input, merged, ReLU, one linear output.

    `add` sums the branches before the ReLU, which couples state and action. `append` puts them
    side by side; then Q = f(s) + g(a), and its action gradient does not depend on the state.

    Args:
        parameters: Layout of `Critic.shapes`; tells which merge it is.
        batch: Pairs of observation and action per pass.
        gradients: Filled by `backward`; None for a pass that never goes back.
        dtype: Compute dtype of the branches; that of the parameters if None.
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
        self,
        parameters: ParameterStack,
        batch: int,
        gradients: ParameterStack | None = None,
        dtype: torch.dtype | None = None,
    ) -> None:
        master = parameters.flat.dtype
        compute = dtype or master
        self._copy = copy = ComputeCopy(parameters, gradients, compute)
        self._observation = _branch(copy, 'observation', batch)
        self._action = Dense(copy.parameters, copy.gradients, 'action', batch)
        self._output = SingleUnit(parameters, gradients, 'output', batch)
        self.value = self._output.output
        self._merged = self._output.input_like(compute)
        self._to_master = Cast(self._merged, master)
        self._to_compute = Cast(self._merged.to(master), compute)
        self._observation_to_compute = Cast(self._observation[0].input_like(master), compute)
        self._action_to_compute = Cast(self._action.input_like(master), compute)
        self._gradient_to_master = Cast(self._action.input_like(compute), master)
        width = self._action.output.shape[-1]
        self._append = self._merged.shape[-1] == 2 * width
        self._observation_part = slice(0, width)
        self._action_part = slice(width, 2 * width) if self._append else slice(0, width)

    def refresh(self) -> None:
        """Take over parameters that have moved."""
        self._copy.refresh()

    def forward(self, observation: Tensor, action: Tensor) -> Tensor:
        """Values (..., batch, 1) in the buffer `value`."""
        self._s = x = self._observation_to_compute(observation)
        self._a = self._action_to_compute(action)
        *below, last = self._observation
        for layer in below:
            x = torch.relu_(layer.forward(x))
        if self._append:
            self._merged[..., self._observation_part] = last.forward(x)
            self._merged[..., self._action_part] = self._action.forward(self._a)
        else:
            last.product(x, last.bias + self._action.bias, self._merged)
            self._action.product(self._a, self._merged, self._merged)
        self._features = self._to_master(torch.relu_(self._merged))
        return self._output.forward(self._features)

    def backward(self, value_gradient: Tensor) -> None:
        """Fill the gradients of the last `forward`, given dL/dQ (..., batch, 1)."""
        merged = self._merged_gradient(value_gradient)
        self._action.backward(self._a, merged[..., self._action_part])
        part = merged[..., self._observation_part]
        _branch_backward(self._observation, self._s, part)
        self._copy.pass_gradients_on()
        self._output.backward(self._features, value_gradient)

    def action_gradient(self, value_gradient: Tensor) -> Tensor:
        """Gradient with respect to the actions of the last `forward`, in a buffer."""
        merged = self._merged_gradient(value_gradient)
        return self._gradient_to_master(
            self._action.backward_input(merged[..., self._action_part])
        )

    def _merged_gradient(self, value_gradient: Tensor) -> Tensor:
        """Gradient before the ReLU that follows the merge."""
        gradient = self._to_compute(self._output.backward_input(value_gradient))
        return relu_backward(gradient, self._merged)


def _branch(copy: ComputeCopy, prefix: str, batch: int) -> list[Dense]:
    """Make the layers '<prefix>0', '<prefix>1', ... that the parameters hold."""
    weights = (name for name in copy.parameters.shapes if 'weight' in name)
    return [
        Dense(copy.parameters, copy.gradients, name.removesuffix('.weight'), batch)
        for name in weights
        if name.startswith(prefix)
    ]


def _branch_backward(layers: list[Dense], x: Tensor, gradient: Tensor) -> None:
    """Fill the gradients of layers with a ReLU between them, given the last output's."""
    for below, layer in zip(layers[-2::-1], layers[:0:-1], strict=True):
        layer.backward(below.output, gradient)
        gradient = relu_backward(layer.backward_input(gradient), below.output)
    layers[0].backward(x, gradient)
