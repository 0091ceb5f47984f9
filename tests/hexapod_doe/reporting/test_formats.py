# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Numbers are written with the digits that matter and no others."""

import math

import pytest
from hexapod_doe.reporting import formats
from hypothesis import given
from hypothesis import strategies as st


@pytest.mark.parametrize(
    ('value', 'text'),
    [
        (0.012345, '0.0123'),
        (1.5, '1.50'),
        (633.4, '633'),
        (-11.12, '−11.1'),
        (123456.0, '123456'),
        (0, '0'),
        (1e-9, '1.00e-09'),
        (None, '–'),
        (math.nan, '–'),
        (math.inf, '–'),
    ],
)
def test_numbers(value, text):
    assert formats.number(value) == text


@given(st.floats(-1e6, 1e6).filter(lambda x: abs(x) > 1e-3), st.integers(2, 6))
def test_a_number_is_right_to_its_digits(value, digits):
    text = formats.number(value, digits).replace('−', '-')
    assert float(text) == pytest.approx(value, rel=0.5 * 10 ** (1 - digits) + 1e-12)


def test_signs_intervals_and_shares():
    assert formats.signed(2.0) == '+2.00'
    assert formats.signed(-2.0) == '−2.00'
    assert formats.signed(None) == '–'
    assert formats.interval((1.0, None)) == '1.00 to –'
    assert formats.interval((None, None)) == '–'
    assert formats.probability(1e-5) == '<0.001'
    assert formats.probability(0.04567) == '0.046'
    assert formats.percent(0.335) == '34 %'
    assert formats.chance(0.9999) == '>99 %'
    assert formats.chance(0.0) == '<1 %'
    assert formats.plain(-0.054) == '−0.054'


def test_a_column_has_the_decimals_of_its_largest_number():
    assert formats.aligned([11.13, -0.944, None], sign=True) == ['+11.1', '−0.9', '–']
    assert formats.aligned([282.0, 0.2], 3, sign=True) == ['+282', '0']
    assert formats.aligned([0.0, None]) == ['0', '–']


def test_counts_and_lists_are_written_for_sentences():
    assert formats.count(1, 'run') == 'one run'
    assert formats.count(4, 'episode') == 'four episodes'
    assert formats.count(12, 'run') == '12 runs'
    assert formats.listing(['A', 'B', 'C']) == 'A, B and C'
    assert formats.listing(list('ABCDE'), 3) == 'A, B, C and 2 more'
    assert formats.listing([]) == ''
    assert formats.capitalised('iMU and more') == 'IMU and more'
