# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hexapod_doe.choosing.estimate import estimate, estimates
from hexapod_doe.designs.design import fraction
from hexapod_doe.fitting.estimands import estimand
from hexapod_doe.fitting.model import corners, estimable_terms
from hexapod_doe.fitting.regression import ols
from hexapod_doe.tables.table import RunTable
from simulated import Truth, repeated_levels, table_of

CASES = Path(__file__).parents[2] / 'data' / 'cases'


def failing_campaign(replicates: int = 10) -> RunTable:
    levels = repeated_levels(fraction('quarter'), replicates)
    return table_of(levels, Truth().simulate(levels, np.random.default_rng(1)))


def test_every_estimand_is_stated() -> None:
    results = estimates(failing_campaign(), 0.9)
    assert [result.name for result in results] == ['mean', 'iqm', 'best_of:3']
    for result in results:
        assert len(result.predictions) == len(result.ranking) == 128
        assert result.choice == result.ranking[0]
        assert all(item.ci[0] < item.fit < item.ci[1] for item in result.predictions.values())


def test_the_mean_is_the_unselected_fit() -> None:
    table = failing_campaign()
    result = estimate(table, estimand('mean'), 0.9)
    fit = ols(table.levels, table.values, estimable_terms(table.levels, 2))
    assert list(result.coef.values()) == pytest.approx(fit.coef)


def test_normal_runs_get_the_classical_interval() -> None:
    # With equal variances every kind comes near t·s·√q.
    rows = repeated_levels(fraction('eighth'), 10)
    table = table_of(rows, 100 + np.random.default_rng(4).normal(0, 8, 160))
    fit = ols(table.levels, table.values, estimable_terms(table.levels, 2))
    classical = 2 * 1.655 * fit.s * np.sqrt(len(fit.terms) / 160)
    for name in ('mean', 'best_of:1'):
        result = estimate(table, estimand(name), 0.9)
        widths = [item.ci[1] - item.ci[0] for item in result.predictions.values()]
        assert np.mean(widths) == pytest.approx(classical, rel=0.05)


def test_one_run_of_a_case_states_nothing() -> None:
    rows = repeated_levels(fraction('eighth'), 1)
    table = table_of(rows, np.random.default_rng(6).normal(size=16))
    assert estimates(table, 0.9) == ()


def test_few_runs_state_what_they_can() -> None:
    table = failing_campaign(replicates=3)
    results = estimates(table, 0.9)
    assert [result.name for result in results] == ['mean']


@pytest.mark.parametrize('failing', [True, False])
def test_two_runs_of_a_case_are_enough_for_an_interval_that_holds(failing: bool) -> None:
    truth = Truth() if failing else Truth(failure={'1': -50.0})
    levels, grid = repeated_levels(fraction('quarter'), 2), corners('ABCDEFG')
    mean, covered = truth.mean(grid), []
    for seed in range(60):
        table = table_of(levels, truth.simulate(levels, np.random.default_rng(seed)))
        found = estimate(table, estimand('mean'), 0.9).predictions.values()
        covered.append([e.ci[0] <= m <= e.ci[1] for e, m in zip(found, mean, strict=True)])
    assert np.mean(covered) == pytest.approx(0.9, abs=0.025)


def test_interactions_that_cannot_be_told_apart_widen_the_intervals() -> None:
    # A Plackett-Burman design in 12 cases, four runs each; the truth is 100 + 5A + 4DE.
    rows = pd.read_csv(CASES / 'F6b_pb12_6factors.csv')
    levels, grid = rows[list('ABCDEF')], corners('ABCDEF')
    noise = float(np.sqrt(rows.groupby(list('ABCDEF'))['y'].var().mean()))
    truth = 100 + 5 * grid['A'] + 4 * grid['D'] * grid['E']
    covered = []
    for seed in range(40):
        y = 100 + 5 * levels['A'] + 4 * levels['D'] * levels['E']
        y += np.random.default_rng(seed).normal(0, noise, len(y))
        found = estimate(table_of(levels, y.to_numpy()), estimand('mean'), 0.9)
        assert found.terms == ('1', *'ABCDEF')
        covered.append(
            [
                e.ci[0] <= t <= e.ci[1]
                for e, t in zip(found.predictions.values(), truth, strict=True)
            ]
        )
    assert np.mean(covered) >= 0.9
