# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import numpy as np
import pytest
from hexapod_doe.failure import failure_threshold


def test_the_gap_between_two_populations() -> None:
    rng = np.random.default_rng(1)
    response = np.concatenate([rng.normal(-40, 70, 60), rng.normal(440, 110, 260)])
    threshold = failure_threshold(response)
    assert 50 < threshold.value < 190


@pytest.mark.parametrize('runs', [16, 32, 80, 320])
def test_one_population_has_no_gap(runs: int) -> None:
    rng = np.random.default_rng(2)
    found = [failure_threshold(rng.normal(size=runs)) for _ in range(100)]
    assert sum(threshold is not None for threshold in found) <= 1


def test_two_low_runs_are_outliers_and_no_population() -> None:
    rng = np.random.default_rng(3)
    assert failure_threshold(np.concatenate([[-900, -950], rng.normal(400, 30, 100)])) is None


def test_a_majority_does_not_fail() -> None:
    rng = np.random.default_rng(4)
    response = np.concatenate([rng.normal(0, 10, 70), rng.normal(500, 100, 30)])
    assert failure_threshold(response) is None


def test_a_fixed_threshold_is_used_as_it_is() -> None:
    threshold = failure_threshold(np.arange(10.0), fixed=4.5)
    assert threshold.value == 4.5
    assert 'fixed by the user' in threshold.rule


def test_equal_responses_have_no_gap() -> None:
    assert failure_threshold(np.ones(20)) is None
