# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Sums are rounded after each addition, from left to right."""

import pytest
from hexapod_sim.sums import ordered_sum


@pytest.mark.parametrize(
    ('values', 'total'),
    [
        ([], 0.0),
        ([1, 2.5], 3.5),
        # 0.1 is a little more than a tenth, ten of them rounded one by one a little less than 1;
        # a compensated sum gives 1.0.
        ([0.1] * 10, 0.9999999999999999),
        # 1 is lost beside 1e100, in that order.
        ([1.0, 1e100, -1e100], 0.0),
        ([1e100, -1e100, 1.0], 1.0),
    ],
)
def test_sum_is_ordered(values, total) -> None:
    assert ordered_sum(iter(values)) == total
