# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A driver's own order and names of the joints in its messages."""

from __future__ import annotations

from array import array
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

JOINT_FIELDS = ('position', 'velocity', 'effort')


@dataclass(frozen=True)
class JointLayout:
    """A driver's own order and names of the joints."""

    order: Sequence[int]
    """Index of our joint at each place; -1 for a joint that is not ours."""
    prefix: str = ''

    @classmethod
    def shuffled(cls, joints: int, extra: int, prefix: str, seed: int) -> JointLayout:
        """Return an order drawn from the seed, with further joints between ours."""
        order = [*range(joints), *[-1] * extra]
        np.random.default_rng(seed).shuffle(order)
        return cls(order, prefix)

    def apply(self, message: Any) -> None:
        """Put names and numbers of a joint message in this order."""
        names, extra = message.name, iter(range(len(self.order)))
        message.name = [
            f'{self.prefix}{names[index]}' if index >= 0 else f'extra_{next(extra)}'
            for index in self.order
        ]
        for field in JOINT_FIELDS:
            values = getattr(message, field)
            if len(values):
                placed = [values[index] if index >= 0 else 0.0 for index in self.order]
                setattr(message, field, array('d', placed))
