# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Layers that the networks are made of, forward and backward over preallocated buffers.

Every tensor has shape (agents, batch, size), or (batch, size) in a stack of one agent, where a
plain matrix product is the faster call.
"""

import torch
from torch import Tensor

from hexapod_agent.parameters import ParameterStack


class Cast:
    """Conversion to a number format through a buffer; free where there is nothing to convert."""

    def __init__(self, like: Tensor, dtype: torch.dtype) -> None:
        self._buffer = None if like.dtype == dtype else torch.empty_like(like, dtype=dtype)

    def __call__(self, tensor: Tensor) -> Tensor:
        """Return the tensor in the other format, valid until the next call."""
        return tensor if self._buffer is None else self._buffer.copy_(tensor)


class Dense:
    """Affine layer y = x Wᵀ + b with buffers for its output and the gradient of its input.

    A layer may compute in a shorter number format than its parameters have. It then works on a
    copy of them that `refresh` takes, and widens its gradients.

    Args:
        parameters: Stack that holds '<name>.weight' and '<name>.bias'.
        gradients: Stack of the same layout that `backward` fills; None where it is never called.
        name: The layer's name.
        batch: Rows of x.
        dtype: Number format of the computation.
    """

    def __init__(
        self,
        parameters: ParameterStack,
        gradients: ParameterStack | None,
        name: str,
        batch: int,
        dtype: torch.dtype,
    ) -> None:
        self._master = (parameters.weight(f'{name}.weight'), parameters.bias(f'{name}.bias'))
        self._is_copy = dtype != parameters.flat.dtype
        self.weight, self.bias = (array.to(dtype) for array in self._master)
        self._transposed = self.weight.mT
        single = parameters.agents == 1
        self._product = torch.mm if single else torch.bmm
        self._add_product = torch.addmm if single else torch.baddbmm
        outputs, inputs = self.weight.shape[-2:]
        leading = () if single else (parameters.agents,)
        self.output = self.weight.new_empty(*leading, batch, outputs)
        if gradients is not None:
            self._weight_gradient = gradients.weight(f'{name}.weight')
            self._bias_gradient = gradients.bias(f'{name}.bias')
            self._narrow_gradient = torch.empty_like(self.weight) if self._is_copy else None
            self._keep_bias_dim = not single
        # The critic's action gradient passes through layers whose own gradients nobody wants.
        self._input_gradient = self.weight.new_empty(*leading, batch, inputs)

    def input_like(self, dtype: torch.dtype) -> Tensor:
        """Make an empty tensor of the input's shape."""
        return torch.empty_like(self._input_gradient, dtype=dtype)

    def refresh(self) -> None:
        """Take over parameters that have moved."""
        if self._is_copy:
            self.weight.copy_(self._master[0])
            self.bias.copy_(self._master[1])

    def forward(self, x: Tensor, out: Tensor | None = None) -> Tensor:
        """Compute y into `out`, or into the layer's own buffer."""
        out = self.output if out is None else out
        return self._add_product(self.bias, x, self._transposed, out=out)

    def add_to(self, y: Tensor, x: Tensor) -> Tensor:
        """Add x Wᵀ + b to y in place."""
        return self._add_product(y, x, self._transposed, out=y).add_(self.bias)

    def backward(self, x: Tensor, y_gradient: Tensor) -> None:
        """Write the gradients of weight and bias: dW = dyᵀ x, db = sum of dy."""
        if self._narrow_gradient is None:
            self._product(y_gradient.mT, x, out=self._weight_gradient)
        else:
            self._product(y_gradient.mT, x, out=self._narrow_gradient)
            self._weight_gradient.copy_(self._narrow_gradient)
        bias_gradient = self._bias_gradient
        torch.sum(
            y_gradient,
            dim=-2,
            keepdim=self._keep_bias_dim,
            dtype=bias_gradient.dtype,
            out=bias_gradient,
        )

    def backward_input(self, y_gradient: Tensor) -> Tensor:
        """Gradient of the input, dx = dy W, in the layer's buffer."""
        return self._product(y_gradient, self.weight, out=self._input_gradient)


def relu_backward(gradient: Tensor, activation: Tensor) -> Tensor:
    """Zero the gradient, in place, where the unit was off."""
    return torch.ops.aten.threshold_backward.grad_input(
        gradient, activation, 0.0, grad_input=gradient
    )


def layer_shapes(name: str, inputs: int, outputs: int) -> dict[str, tuple[int, ...]]:
    """Names and shapes of a layer's two arrays."""
    return {f'{name}.weight': (outputs, inputs), f'{name}.bias': (outputs,)}
