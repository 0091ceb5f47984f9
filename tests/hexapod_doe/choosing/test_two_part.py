# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import numpy as np
import pytest
from hexapod_doe.choosing.two_part import fit_parts, select_parts
from hexapod_doe.designs.design import fraction
from hexapod_doe.fitting.model import corners, labels
from hexapod_doe.studies.simulated import Truth, repeated_levels, table_of
from hexapod_doe.tables.table import RunTable

GRID = corners('ABCDEFG')
TRUTH = Truth(success={'1': 420, 'C': 95, 'B': 30, 'CE': 20}, failure={'1': -1.6, 'C': -0.55})


def failing_campaign(replicates: int = 10) -> RunTable:
    levels = repeated_levels(fraction('quarter'), replicates)
    return table_of(levels, TRUTH.simulate(levels, np.random.default_rng(1)))


def test_both_parts_find_the_truth() -> None:
    table = failing_campaign(replicates=40)
    parts = fit_parts(table, 130.0)
    pi, mu, expected = parts.point()
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
    assert draws.expected.mean(axis=0) == pytest.approx(expected, abs=8)
    assert draws.pi.mean() == pytest.approx(pi.mean(), abs=0.02)


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
