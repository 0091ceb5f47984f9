# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Numbers of cells are read in the one way that is possible, or not at all."""

import math

import pytest
from hexapod_doe.sheets.numbers import COMMA, POINT, decimal_mark, number
from hypothesis import given
from hypothesis import strategies as st


@pytest.mark.parametrize(
    ('cell', 'mark', 'value'),
    [
        ('166.4', POINT, 166.4),
        ('166,4', COMMA, 166.4),
        (' −1 ', POINT, -1.0),
        ('–1,5', COMMA, -1.5),
        ('+2', POINT, 2.0),
        ('.5', POINT, 0.5),
        ('5.', POINT, 5.0),
        ('1,5E+02', COMMA, 150.0),
        ('1,234.5', POINT, 1234.5),
        ('1.234.567,5', COMMA, 1234567.5),
        ('1 234,5', COMMA, 1234.5),
        ('1\u202f234\u00a0567', POINT, 1234567.0),
        ("1'234.5", POINT, 1234.5),
        ('="-1"', POINT, -1.0),
        ('-inf', POINT, -math.inf),
    ],
)
def test_numbers_as_people_write_them(cell: str, mark: str, value: float) -> None:
    assert number(cell, mark) == value


@pytest.mark.parametrize(
    'cell',
    ['', '45 %', '1_000', '10²', '1,23,4', '0x1F', '1.2.3', '(5)', '5-', '--5', '1 2', 'e5'],
)
@pytest.mark.parametrize('mark', [POINT, COMMA])
def test_what_is_no_number(cell: str, mark: str) -> None:
    with pytest.raises(ValueError, match='no number'):
        number(cell, mark)


@pytest.mark.parametrize(
    ('cells', 'separator', 'mark'),
    [
        (['166.4', '-1'], ',', POINT),
        (['166,4', '-1'], ',', COMMA),
        (['1,234', '5.5'], ',', POINT),
        (['1.234', '5,5'], '\t', COMMA),
        (['1,234', '1,234,567'], ',', POINT),
        (['0,123'], ',', COMMA),
        (['1,234'], ';', COMMA),
        (['1.234'], ';', POINT),
        (['*', '.', '12'], ';', POINT),
    ],
)
def test_the_decimal_mark_that_the_cells_show(cells: list[str], separator: str, mark: str) -> None:
    assert decimal_mark(cells, separator) == mark


@pytest.mark.parametrize(
    ('cells', 'separator', 'words'),
    [
        (['166,4', '167.0'], ';', "'167.0' has a decimal point and '166,4' a decimal comma"),
        (['1,234'], ',', "'1,234' may have a decimal comma or a comma that parts thousands"),
        (['1,234'], '\t', 'may have a decimal comma'),
        (['1,234', '1.234'], ';', 'may have a decimal comma'),
    ],
)
def test_two_readings_are_refused(cells: list[str], separator: str, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        decimal_mark(cells, separator)


@given(st.floats(-1e9, 1e9), st.sampled_from([POINT, COMMA]), st.booleans())
def test_a_number_comes_back(value: float, mark: str, grouped: bool) -> None:
    text = f'{value:,.2f}' if grouped else f'{value:.2f}'
    if mark == COMMA:
        text = text.translate(str.maketrans('.,', ',.'))
    assert number(text, mark) == float(f'{value:.2f}')
