# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import math

import numpy as np
import pytest
from hexapod_doe.campaigns.curves import limits, sparkline, thin
from hypothesis import given
from hypothesis import strategies as st

RETURNS = st.lists(st.floats(-1e6, 1e6), max_size=300)


@given(RETURNS, st.integers(1, 60))
def test_thinning_keeps_the_length_and_the_range(returns, points):
    curve = thin(returns, points)
    assert len(curve) == min(points, len(returns))
    if returns:
        assert curve.min() >= min(returns) - 1e-6
        assert curve.max() <= max(returns) + 1e-6


def test_thinning_takes_means_of_stretches():
    assert thin([1.0, 3.0, 5.0, 7.0], 2) == pytest.approx([2.0, 6.0])


def test_returns_that_nobody_saw_do_not_count():
    assert thin([math.nan, math.nan, 4.0], 10) == pytest.approx([4.0])
    assert thin([math.nan], 10).size == 0


@given(st.lists(RETURNS, max_size=5))
def test_limits_are_a_range_that_can_be_divided_by(curves):
    low, high = limits(np.asarray(curve) for curve in curves)
    assert low < high


def test_limits_leave_out_what_lies_far_off():
    curve = np.concatenate([np.linspace(0.0, 1.0, 99), [-1000.0]])
    low, _ = limits([curve])
    assert low >= 0.0


def test_a_sparkline_rises_from_the_lowest_block_to_the_highest():
    assert sparkline(np.linspace(10.0, 17.0, 8), 10.0, 17.0) == '▁▂▃▄▅▆▇█'
    assert sparkline(np.array([-99.0, 99.0]), 10.0, 17.0) == '▁█'
    assert sparkline(np.empty(0), 0.0, 1.0) == ''
