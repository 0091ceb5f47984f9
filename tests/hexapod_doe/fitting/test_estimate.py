# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import numpy as np
import pytest
from hexapod_doe.choosing.estimands import estimand
from hexapod_doe.designs.design import fraction
from hexapod_doe.fitting.estimate import estimate, estimates
from hexapod_doe.fitting.model import estimable_terms
from hexapod_doe.fitting.regression import ols
from hexapod_doe.studies.simulated import Truth, repeated_levels, table_of
from hexapod_doe.tables.table import RunTable


def failing_campaign(replicates: int = 10) -> RunTable:
    levels = repeated_levels(fraction('quarter'), replicates)
    return table_of(levels, Truth().simulate(levels, np.random.default_rng(1)))


def test_every_estimand_is_stated() -> None:
    results = estimates(failing_campaign(), 0.9, np.random.default_rng(1))
    assert [result.name for result in results] == ['mean', 'iqm', 'best_of:3']
    for result in results:
        assert len(result.predictions) == len(result.ranking) == 128
        assert result.choice == result.ranking[0]
        assert all(item.ci[0] < item.fit < item.ci[1] for item in result.predictions.values())


def test_the_mean_is_the_unselected_fit() -> None:
    table = failing_campaign()
    result = estimate(table, estimand('mean'), 0.9, np.random.default_rng(1))
    fit = ols(table.levels, table.values, estimable_terms(table.levels, 2))
    assert list(result.coef.values()) == pytest.approx(fit.coef)


def test_normal_runs_get_the_classical_interval() -> None:
    # With equal variances both kinds come near t·s·√q; the bootstrap's makes up for ten runs of
    # a case by t of 9 instead of 144 degrees of freedom, 1.107 times as wide.
    rows = repeated_levels(fraction('eighth'), 10)
    table = table_of(rows, 100 + np.random.default_rng(4).normal(0, 8, 160))
    fit = ols(table.levels, table.values, estimable_terms(table.levels, 2))
    classical = 2 * 1.655 * fit.s * np.sqrt(len(fit.terms) / 160)
    for name, factor in (('mean', 1.107), ('best_of:1', 1.0)):
        result = estimate(table, estimand(name), 0.9, np.random.default_rng(5))
        widths = [item.ci[1] - item.ci[0] for item in result.predictions.values()]
        assert np.mean(widths) == pytest.approx(factor * classical, rel=0.05)


def test_one_run_of_a_case_states_nothing() -> None:
    rows = repeated_levels(fraction('eighth'), 1)
    table = table_of(rows, np.random.default_rng(6).normal(size=16))
    assert estimates(table, 0.9, np.random.default_rng(1)) == ()


def test_few_runs_state_what_they_can() -> None:
    table = failing_campaign(replicates=3)
    results = estimates(table, 0.9, np.random.default_rng(1))
    assert [result.name for result in results] == ['mean']
