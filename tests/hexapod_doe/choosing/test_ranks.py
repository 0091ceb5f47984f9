# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import numpy as np
from hexapod_doe.choosing.ranks import groups, ranks_of


def test_ranks_within_each_draw() -> None:
    draws = np.array([[1.0, 3.0, 2.0], [5.0, 5.0, 6.0]])
    assert ranks_of(draws).tolist() == [[3, 1, 2], [2, 3, 1]]


def test_groups_open_where_the_first_one_is_surely_better() -> None:
    rng = np.random.default_rng(1)
    fits = np.array([10.0, 9.9, 5.0, 4.9])
    draws = fits + rng.normal(0, 0.5, (4000, 4))
    assert groups(draws, fits, list('abcd'), 0.9) == (('a', 'b'), ('c', 'd'))


def test_equal_values_are_one_group() -> None:
    draws = np.ones((10, 3))
    assert groups(draws, np.ones(3), list('abc'), 0.9) == (('a', 'b', 'c'),)
