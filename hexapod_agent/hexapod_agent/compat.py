# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What is used of libraries beyond their documented names; a test of each fails when one moves."""

from collections.abc import Sequence

import torch
from tensorboardX.event_file_writer import EventsWriter
from tensorboardX.proto.event_pb2 import Event, SessionLog
from tensorboardX.summary import scalar
from torch import Tensor

__all__ = [
    'Event',
    'EventsWriter',
    'SessionLog',
    'fused_adam',
    'relu_backward',
    'scalar',
]
_DECAY_MEAN, _DECAY_SQUARE, _EPSILON = 0.9, 0.999, 1e-8


def fused_adam(rows: Sequence[list[Tensor]], learning_rate: float) -> None:
    """Take a step of Adam in place, by the kernel that `torch.optim.Adam(fused=True)` calls.

    Its `step` looks at every group and state anew, which takes as long as the kernel.

    Args:
        rows: Parameters, their gradients, first and second moments, all alike, and the number of
            the step of each, from 1, float32 of shape ().
        learning_rate: Step size.
    """
    parameters, gradients, means, squares, steps = rows
    torch._fused_adam_(
        parameters, gradients, means, squares, [], steps,
        lr=learning_rate, beta1=_DECAY_MEAN, beta2=_DECAY_SQUARE,
        weight_decay=0.0, eps=_EPSILON, amsgrad=False, maximize=False,
    )  # fmt: skip


def relu_backward(gradient: Tensor, activation: Tensor) -> Tensor:
    """Zero the gradient, in place, where the unit was off."""
    torch.ops.aten.threshold_backward.grad_input(gradient, activation, 0.0, grad_input=gradient)
    return gradient
