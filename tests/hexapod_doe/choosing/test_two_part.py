# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

from pathlib import Path

import numpy as np
import pytest
from hexapod_doe.analysis.analysis import analyse
from hexapod_doe.choosing.two_part import fit_parts, select_parts
from hexapod_doe.designs.design import fraction
from hexapod_doe.fitting.model import corners, labels
from hexapod_doe.records.options import Options
from hexapod_doe.tables.csv_table import read_csv
from hexapod_doe.tables.table import RunTable
from simulated import Truth, repeated_levels, table_of

CASES = Path(__file__).parents[2] / 'data' / 'cases'

GRID = corners('ABCDEFG')
TRUTH = Truth(success={'1': 420, 'C': 95, 'B': 30, 'CE': 20}, failure={'1': -1.6, 'C': -0.55})


def failing_campaign(replicates: int = 10) -> RunTable:
    levels = repeated_levels(fraction('quarter'), replicates)
    return table_of(levels, TRUTH.simulate(levels, np.random.default_rng(1)))


def test_both_parts_find_the_truth() -> None:
    table = failing_campaign(replicates=40)
    parts = fit_parts(table, 130.0)
    _, mu, expected = parts.point()
    pi = select_parts(table, parts, 130.0, 0.05).point()[0]
    assert pi == pytest.approx(TRUTH.p_failure(GRID), abs=0.1)
    assert mu == pytest.approx(TRUTH.reward_success(GRID), abs=25)
    assert expected == pytest.approx(TRUTH.mean(GRID), abs=60)


def test_selection_leaves_what_matters() -> None:
    table = failing_campaign(replicates=40)
    selected = select_parts(table, fit_parts(table, 130.0), 130.0, alpha=0.001)
    assert selected.failure_terms == ('1', 'C')
    assert selected.success.terms == ('1', 'B', 'C', 'E', 'CE')


def test_the_expected_reward_is_the_mixture() -> None:
    parts = fit_parts(failing_campaign(), 130.0)
    pi, mu, expected = parts.point()
    assert expected == pytest.approx((1 - pi) * mu + pi * parts.failed.mean())


def test_draws_scatter_about_the_point() -> None:
    parts = fit_parts(failing_campaign(), 130.0)
    draws = parts.draw(4000, np.random.default_rng(1))
    pi, mu, expected = parts.point()
    assert draws.mu.mean(axis=0) == pytest.approx(mu, abs=2)
    assert np.median(draws.pi, axis=0) == pytest.approx(pi, abs=0.03)
    assert np.median(draws.expected, axis=0) == pytest.approx(expected, abs=8)


def test_future_runs_hold_failures() -> None:
    parts = fit_parts(failing_campaign(), 130.0)
    rng = np.random.default_rng(2)
    draws = parts.draw(4000, rng)
    one = draws.future_mean(1, rng)
    best = labels(GRID).index('BCE')
    assert (one[:, best] < 130).mean() == pytest.approx(draws.pi[:, best].mean(), abs=0.03)
    assert draws.future_mean(20, rng).std() < one.std()


def test_too_few_failures_are_no_population() -> None:
    assert fit_parts(failing_campaign(), -1000.0) is None


def test_few_successes_get_a_smaller_model() -> None:
    rows = repeated_levels(fraction('eighth'), 2)
    reward = np.random.default_rng(3).normal(100, 10, 32)
    reward[::2] = -100.0 + np.arange(16)
    table = table_of(rows, reward)
    assert fit_parts(table, 0.0).success.terms == ('1', *'ABCDEFG')


@pytest.mark.parametrize('threshold', [44, 60, 95, 100, 101, 104])
def test_any_threshold_ends_in_a_model_or_in_none(threshold: float) -> None:
    (table,) = read_csv(CASES / '60_fail_one_success.csv', 'y')
    parts = fit_parts(table, threshold)
    if parts is not None:
        assert set(table.factors) < set(parts.success.terms)
        analysis = analyse([table], Options(failure_threshold=threshold))
        assert analysis.two_part is not None
        assert np.isfinite([e.fit for e in analysis.two_part.expected.values()]).all()
    else:
        assert threshold >= 95


def test_a_failure_that_depends_on_two_sensors_together_is_seen() -> None:
    # Probabilities to be best of 0.90 were claimed for sets that never are.
    (table,) = read_csv(CASES / 'S1_failure_interaction_BC.csv', 'y')
    analysis = analyse([table], Options())
    parts = analysis.two_part
    assert parts is not None
    assert 'BC' in parts.selected_failure_terms
    assert parts.failure_lack_of_fit is not None
    assert parts.failure_lack_of_fit > 0.05
    failed = table.values < parts.threshold
    shares = table.rows.assign(failed=failed).groupby(['B', 'C'])['failed'].mean()
    grid = corners(table.factors)
    pi = [parts.p_failure[name].fit for name in labels(grid)]
    fitted = grid.assign(pi=pi).groupby(['B', 'C'])['pi'].mean()
    assert fitted.to_numpy() == pytest.approx(shares.to_numpy(), abs=0.07)


def test_a_model_of_failures_that_misses_something_says_so() -> None:
    truth = Truth(failure={'1': -1.0, 'B': 1.0, 'C': -1.0, 'BCE': 2.5})
    levels = repeated_levels(fraction('quarter'), 10)
    table = table_of(levels, truth.simulate(levels, np.random.default_rng(2)))
    analysis = analyse([table], Options(failure_threshold=130.0))
    assert any('does not fit the shares' in caveat for caveat in analysis.caveats)


def test_few_failures_leave_main_effects() -> None:
    truth = Truth(failure={'1': -3.0})
    levels = repeated_levels(fraction('quarter'), 10)
    table = table_of(levels, truth.simulate(levels, np.random.default_rng(2)))
    parts = fit_parts(table, 130.0)
    assert parts is not None
    assert parts.failure_terms == ('1', *'ABCDEFG')
    analysis = analyse([table], Options(failure_threshold=130.0))
    assert any('holds main effects only' in caveat for caveat in analysis.caveats)


def test_two_runs_of_a_case_are_said_to_be_few() -> None:
    for replicates, told in ((2, True), (10, False)):
        analysis = analyse([failing_campaign(replicates)], Options(failure_threshold=130.0))
        assert analysis.two_part is not None
        assert any('are too sure' in text for text in analysis.caveats) is told
