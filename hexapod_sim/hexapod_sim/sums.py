# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Sums of floats that are the same on every interpreter."""

from collections.abc import Iterable
from functools import reduce
from operator import add


def ordered_sum(values: Iterable[float]) -> float:
    """Return the sum of values, rounded after each addition from the first to the last.

    Python's own `sum` does that until 3.11 and compensates what rounding loses since 3.12: the
    rewards of a training would depend on the interpreter.
    """
    return reduce(add, values, 0.0)
