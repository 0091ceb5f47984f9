# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Layers that the networks are made of, forward and backward over preallocated buffers.

Every tensor has shape (agents, batch, size), or (batch, size) in a stack of one agent, where a
plain matrix product is the faster call.
"""

import torch
from torch import Tensor

from hexapod_agent.algorithms.ddpg.parameters import ParameterStack


class Cast:
    """Conversion to a dtype through a buffer; free where there is nothing to convert."""

    def __init__(self, like: Tensor, dtype: torch.dtype) -> None:
        self._buffer = None if like.dtype == dtype else torch.empty_like(like, dtype=dtype)

    def __call__(self, tensor: Tensor) -> Tensor:
        """Return the tensor in the other dtype, valid until the next call."""
        return tensor if self._buffer is None else self._buffer.copy_(tensor)


class ComputeCopy:
    """A network's master weights copied to the compute dtype, with the gradients of the copy.

    Where that is the dtype of the master weights, the copy is they themselves.

    Attributes:
        parameters: What layers compute with.
        gradients: What they fill; None if the network never goes back.
    """

    def __init__(
        self, parameters: ParameterStack, gradients: ParameterStack | None, dtype: torch.dtype
    ) -> None:
        self._master, self._master_gradients = parameters, gradients
        self._is_copy = dtype != parameters.flat.dtype
        self.parameters, self.gradients = parameters, gradients
        if self._is_copy:
            self.parameters = parameters.like(dtype)
            self.gradients = gradients and gradients.like(dtype)
            self.refresh()

    def refresh(self) -> None:
        """Take over master weights that have moved."""
        if self._is_copy:
            self.parameters.flat.copy_(self._master.flat)

    def pass_gradients_on(self) -> None:
        """Write the gradients to those of the master weights."""
        if self._is_copy and self.gradients is not None and self._master_gradients is not None:
            self._master_gradients.flat.copy_(self.gradients.flat)


class Dense:
    """Affine layer y = x Wᵀ + b with buffers for its output and the gradient of its input.

    Args:
        parameters: Stack that holds '<name>.weight' and '<name>.bias'.
        gradients: Stack of the same layout that `backward` fills; None where it is never called.
        name: The layer's name.
        batch: Rows of x.
    """

    def __init__(
        self,
        parameters: ParameterStack,
        gradients: ParameterStack | None,
        name: str,
        batch: int,
    ) -> None:
        self.weight = parameters.weight(f'{name}.weight')
        self.bias = parameters.bias(f'{name}.bias')
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
            self._keep_bias_dim = not single
        # The critic's action gradient passes through layers whose own gradients nobody wants.
        self._input_gradient = self.weight.new_empty(*leading, batch, inputs)

    def input_like(self, dtype: torch.dtype) -> Tensor:
        """Make an empty tensor of the input's shape."""
        return torch.empty_like(self._input_gradient, dtype=dtype)

    def forward(self, x: Tensor) -> Tensor:
        """Compute y into the layer's own buffer."""
        return self.product(x, self.bias, self.output)

    def product(self, x: Tensor, addend: Tensor, out: Tensor) -> Tensor:
        """Compute x Wᵀ + addend, where the addend may be `out` itself."""
        return self._add_product(addend, x, self._transposed, out=out)

    def backward(self, x: Tensor, y_gradient: Tensor) -> None:
        """Write the gradients of weight and bias: dW = dyᵀ x, db = sum of dy."""
        self._product(y_gradient.mT, x, out=self._weight_gradient)
        self._sum_bias_gradient(y_gradient)

    def _sum_bias_gradient(self, y_gradient: Tensor) -> None:
        torch.sum(y_gradient, dim=-2, keepdim=self._keep_bias_dim, out=self._bias_gradient)

    def backward_input(self, y_gradient: Tensor) -> Tensor:
        """Gradient of the input, dx = dy W, in the layer's buffer."""
        return self._product(y_gradient, self.weight, out=self._input_gradient)


class SingleUnit(Dense):
    """A layer of one unit, by sums over products: a matrix product's call alone takes longer.

    The buffer of the input's gradient holds the products, so `forward` and `backward` spoil it.
    """

    def forward(self, x: Tensor) -> Tensor:
        """Compute y, of shape (..., batch, 1)."""
        products = torch.mul(x, self.weight, out=self._input_gradient)
        torch.sum(products, dim=-1, keepdim=True, out=self.output)
        return self.output.add_(self.bias)

    def backward(self, x: Tensor, y_gradient: Tensor) -> None:
        """Write the gradients of weight and bias."""
        products = torch.mul(x, y_gradient, out=self._input_gradient)
        torch.sum(products, dim=-2, keepdim=True, out=self._weight_gradient)
        self._sum_bias_gradient(y_gradient)

    def backward_input(self, y_gradient: Tensor) -> Tensor:
        """Gradient of the input, an outer product."""
        return torch.mul(y_gradient, self.weight, out=self._input_gradient)


def layer_shapes(name: str, inputs: int, outputs: int) -> dict[str, tuple[int, ...]]:
    """Names and shapes of a layer's two arrays."""
    return {f'{name}.weight': (outputs, inputs), f'{name}.bias': (outputs,)}
