# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Types of a specification's numbers, with what they may be.

Far wider than anything sensible, but with these nothing divides by zero, waits for ever or is not
a number.
"""

from typing import Annotated

from annotated_types import Interval, MinLen

Count = Annotated[int, Interval(ge=1, le=10_000_000)]
CountOrNone = Annotated[int, Interval(ge=0, le=1_000_000)]
Rows = Annotated[int, Interval(ge=1, le=1_000_000_000)]
Layers = Annotated[tuple[Annotated[int, Interval(ge=1, le=100_000)], ...], MinLen(1)]
Factor = Annotated[float, Interval(ge=0.0, le=1e6)]
PositiveFactor = Annotated[float, Interval(gt=0.0, le=1e6)]
Share = Annotated[float, Interval(ge=0.0, le=1.0)]
Value = Annotated[float, Interval(ge=-1e9, le=1e9)]
