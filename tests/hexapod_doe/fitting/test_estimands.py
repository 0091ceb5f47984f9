# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

from itertools import combinations

import numpy as np
import pandas as pd
import pytest
from hexapod_doe.errors import AnalysisError, TableError
from hexapod_doe.fitting.estimands import Estimand, estimand, pseudo_values

SQUARES = np.arange(1.0, 11.0) ** 2
CASE = pd.Series([7] * 10)


def summary(item: Estimand, runs: np.ndarray) -> float:
    return np.sort(runs) @ item.weights(len(runs))


def test_the_exact_interquartile_mean_of_ten() -> None:
    # Squares 1..10: the 3rd and the 8th count by half, 32.5 (SciPy's trimmed mean gives 33.17).
    assert summary(estimand('iqm'), SQUARES) == pytest.approx(32.5)


def test_best_of_three_is_the_mean_over_all_triples() -> None:
    expected = np.mean([max(triple) for triple in combinations(SQUARES, 3)])
    assert summary(estimand('best_of:3'), SQUARES) == pytest.approx(expected)


def test_pseudo_values_of_the_mean_are_the_runs() -> None:
    assert (pseudo_values(estimand('mean'), SQUARES, CASE) == SQUARES).all()


def test_pseudo_values_of_best_of_average_to_the_estimate() -> None:
    # A U-statistic has no bias, so that its jackknife estimate is itself.
    item = estimand('best_of:3')
    found = pseudo_values(item, SQUARES, CASE)
    assert found.mean() == pytest.approx(summary(item, SQUARES))


def test_pseudo_values_are_the_jackknife() -> None:
    item = estimand('iqm')
    runs = np.random.default_rng(1).normal(size=6)
    whole = summary(item, runs)
    expected = [6 * whole - 5 * summary(item, np.delete(runs, i)) for i in range(6)]
    assert pseudo_values(item, runs, pd.Series([1] * 6)) == pytest.approx(expected)


def test_cases_are_kept_apart() -> None:
    case = pd.Series([2, 1] * 5)
    runs = np.random.default_rng(2).normal(size=10)
    item = estimand('iqm')
    found = pseudo_values(item, runs, case)
    assert found[::2] == pytest.approx(pseudo_values(item, runs[::2], pd.Series([1] * 5)))


def test_too_few_runs() -> None:
    with pytest.raises(TableError, match='case 7 has 10 runs: best_of:10 needs 11'):
        pseudo_values(estimand('best_of:10'), SQUARES, CASE)


@pytest.mark.parametrize('name', ['median', 'best_of', 'best_of:0', 'best_of:x'])
def test_unknown_estimands(name: str) -> None:
    with pytest.raises(AnalysisError, match='expected mean, iqm or best_of:m'):
        estimand(name)
