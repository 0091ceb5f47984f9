# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Storage of a network's parameters for a stack of agents: one flat tensor with a view per array.

Optimiser, gradient norms and target smoothing work on the flat tensor, the layers on the views.
"""

import math
from collections.abc import Mapping

import torch
from torch import Tensor

_ALIGNMENT = 16  # arrays start at multiples of 16 numbers, a cache line of float32


class ParameterStack:
    """All arrays of one network for `agents` agents.

    Attributes:
        flat: Tensor (agents, P), weights first, then biases. Numbers between two arrays are
            padding, always 0.
        flat_weights: The part of it that holds the weights.
        arrays: Views (agents, *shape) by name; two-dimensional shapes (out, in) are weights.
    """

    def __init__(
        self, shapes: Mapping[str, tuple[int, ...]], agents: int = 1,
        dtype: torch.dtype = torch.float32, device: torch.device | str = 'cpu',
    ) -> None:  # fmt: skip
        self.shapes = dict(shapes)
        self.agents = agents
        offsets = {}
        size = weights_size = 0
        for name, shape in sorted(self.shapes.items(), key=lambda item: -len(item[1])):
            offsets[name] = size
            size += -(-math.prod(shape) // _ALIGNMENT) * _ALIGNMENT
            if len(shape) == 2:
                weights_size = size
        self.flat = torch.zeros(agents, size, dtype=dtype, device=device)
        self.flat_weights = self.flat[:, :weights_size]
        self.arrays = {
            name: self.flat[:, offsets[name] :][:, : math.prod(shape)].unflatten(1, shape)
            for name, shape in self.shapes.items()
        }

    def like(self, dtype: torch.dtype | None = None) -> 'ParameterStack':
        """Make a stack of the same layout, filled with zeros: gradients."""
        dtype = dtype or self.flat.dtype
        return ParameterStack(self.shapes, self.agents, dtype, self.flat.device)

    def copy(self) -> 'ParameterStack':
        """Make a stack of the same layout with the same numbers: a target network."""
        copy = self.like()
        copy.flat.copy_(self.flat)
        return copy

    def weight(self, name: str) -> Tensor:
        """View of a weight (agents, out, in); (out, in) for a stack of one."""
        array = self.arrays[name]
        return array[0] if self.agents == 1 else array

    def bias(self, name: str) -> Tensor:
        """View of a bias (agents, 1, out), broadcast over a batch; (out,) for a stack of one."""
        array = self.arrays[name]
        return array[0] if self.agents == 1 else array.unsqueeze(1)

    def draw(self, bounds: Mapping[str, float], generator: torch.Generator) -> None:
        """Draw every array from U(-bound, bound), agent by agent, in the order of the layout."""
        for agent in range(self.agents):
            for name, array in self.arrays.items():
                array[agent].uniform_(-bounds[name], bounds[name], generator=generator)

    def put(self, agent: int, single: 'ParameterStack') -> None:
        """Make a stack of one this stack's agent, its smaller arrays padded with zeros.

        Zero columns for inputs that are always zero change nothing and stay zero: their gradient
        is zero, and so are their L2 term and their moments.
        """
        for name, array in single.arrays.items():
            self.arrays[name][agent].zero_()
            self._part(agent, name, array).copy_(array[0])

    def take(self, agent: int, single: 'ParameterStack') -> None:
        """Write an agent of this stack to a stack of one, without the padding."""
        for name, array in single.arrays.items():
            array[0].copy_(self._part(agent, name, array))

    def _part(self, agent: int, name: str, like: Tensor) -> Tensor:
        """View of one agent's array, as much of it as a stack of one has."""
        return self.arrays[name][agent][tuple(slice(size) for size in like.shape[1:])]
