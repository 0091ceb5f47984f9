# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import pytest
from hexapod_doe.errors import AnalysisError
from hexapod_doe.fitting.lenth import lenth


def test_active_effects_are_beyond_the_margin() -> None:
    # Filtration rate, Montgomery Example 6.2: A, C, D, AC and AD are active.
    effects = {
        'A': 21.625, 'B': 3.125, 'C': 9.875, 'D': 14.625, 'AB': 0.125, 'AC': -18.125,
        'AD': 16.625, 'BC': 2.375, 'BD': -0.375, 'CD': -1.125, 'ABC': 1.875, 'ABD': 4.125,
        'ACD': -1.625, 'BCD': -2.625, 'ABCD': 1.375,
    }  # fmt: skip
    found = lenth(effects)
    assert found.pse == pytest.approx(2.625)
    assert found.active == ('A', 'C', 'D', 'AC', 'AD')
    assert found.clearly_active == ('A', 'D', 'AC', 'AD')


def test_two_effects_are_too_few() -> None:
    with pytest.raises(AnalysisError, match='2 effects'):
        lenth({'A': 1.0, 'B': 2.0})


def test_effects_of_zero_leave_no_margin() -> None:
    found = lenth(dict.fromkeys('ABCDEFG', 0.0))
    assert (found.pse, found.margin, found.active) == (0, 0, ())
