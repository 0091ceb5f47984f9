# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What a training sets of torch for the whole process; acting sets nothing."""

import torch


def set_numerics(precision: str) -> None:
    """Let torch compute as `TrainingConfig.precision` says, and the same to the last bit always.

    Whoever steps through a training calls it before the first update.
    """
    # One thread: a sum split over threads is not the same to the last bit.
    torch.set_num_threads(1)
    torch.set_float32_matmul_precision('highest' if precision == 'float32' else 'medium')
