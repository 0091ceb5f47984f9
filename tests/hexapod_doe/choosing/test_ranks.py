# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

from pathlib import Path

import numpy as np
import pytest
from hexapod_doe.analysis.analysis import analyse
from hexapod_doe.choosing.ranks import groups, ranks_of, share_of_top
from hexapod_doe.records.options import Options
from hexapod_doe.tables.csv_table import read_csv

DATA = Path(__file__).parents[2] / 'data' / 'doe_cases'


def test_ranks_within_each_draw() -> None:
    draws = np.array([[1.0, 3.0, 2.0], [5.0, 5.0, 6.0]])
    assert ranks_of(draws).tolist() == [[3, 1, 2], [2, 3, 1]]


def test_equal_values_share_their_places() -> None:
    # First draw: b alone, then a and c on places 2 and 3, d last. Second draw: all four alike.
    draws = np.array([[2.0, 3.0, 2.0, 1.0], [0.1 + 0.2, 0.3, 0.3, 0.3]])
    assert share_of_top(draws, 1).tolist() == [1 / 8, 5 / 8, 1 / 8, 1 / 8]
    assert share_of_top(draws, 2).tolist() == [1 / 2, 3 / 4, 1 / 2, 1 / 4]
    assert share_of_top(draws, 3).tolist() == [7 / 8, 7 / 8, 7 / 8, 3 / 8]


def test_a_sensor_that_the_model_dropped_is_worth_even_odds() -> None:
    # Filtration: the final model holds A, C, D and what they do together, but not B.
    rows = read_csv(DATA / 'filtration_2_4.csv', 'y')[0]
    analysis = analyse([rows], Options(terms='A,C,D,AC,AD'))
    assert analysis.choice == 'AD'
    assert analysis.choice_rule.endswith('of 2 equal sets the one with fewest letters')
    ranks = analysis.rank_uncertainty
    assert ranks is not None
    assert ranks.p_best['AD'] == ranks.p_best['ABD'] > 0.45
    assert sum(ranks.p_best.values()) == pytest.approx(1)
    assert sum(ranks.p_top3.values()) == pytest.approx(3)


def test_groups_open_where_the_first_one_is_surely_better() -> None:
    rng = np.random.default_rng(1)
    fits = np.array([10.0, 9.9, 5.0, 4.9])
    draws = fits + rng.normal(0, 0.5, (4000, 4))
    assert groups(draws, fits, list('abcd'), 0.9) == (('a', 'b'), ('c', 'd'))


def test_equal_values_are_one_group() -> None:
    draws = np.ones((10, 3))
    assert groups(draws, np.ones(3), list('abc'), 0.9) == (('a', 'b', 'c'),)


@pytest.mark.parametrize('offset', [0.0, 1e12, -1e12])
def test_sets_are_equal_by_their_differences_not_by_their_distance_from_zero(
    offset: float,
) -> None:
    draws = np.array([[0.0, 40.0, 40.0], [1.0, 2.0, 3.0]]) + offset
    assert share_of_top(draws, 1) == pytest.approx([0, 0.25, 0.75])
