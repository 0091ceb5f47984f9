# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import numpy as np
import pytest
from hexapod_doe.choosing.failure import failure_threshold, two_groups
from hexapod_doe.designs.design import fraction
from hexapod_doe.tables.caveats import unseen_caveat
from scipy import special
from simulated import Truth, repeated_levels


def cases(runs: int, replicates: int = 10) -> np.ndarray:
    return np.repeat(np.arange(runs), replicates)[:runs]


def two_populations(seed: int = 1) -> np.ndarray:
    """A fifth of 320 runs failed, spread over all cases."""
    rng = np.random.default_rng(seed)
    failed = rng.random(320) < 0.2
    return np.where(failed, rng.normal(-40, 70, 320), rng.normal(440, 110, 320))


def test_the_gap_between_two_populations() -> None:
    threshold = failure_threshold(two_populations(), cases(320))
    assert 50 < threshold.value < 190


@pytest.mark.parametrize('runs', [16, 32, 80, 320])
def test_one_population_has_no_gap(runs: int) -> None:
    rng = np.random.default_rng(2)
    found = [failure_threshold(rng.normal(size=runs), cases(runs)) for _ in range(100)]
    assert sum(threshold is not None for threshold in found) <= 1


def test_a_strong_factor_is_no_failure() -> None:
    # A quarter of the cases earns 300 less: a gap as wide, but between cases.
    rng = np.random.default_rng(3)
    reward = np.where(cases(320) % 4 == 0, 400, 700) + rng.normal(0, 40, 320)
    assert failure_threshold(reward, cases(320)) is None
    scattered = rng.permutation(320)
    assert failure_threshold(reward[scattered], cases(320)) is not None


def test_single_runs_show_no_failure() -> None:
    runs = two_populations()[:64]
    assert failure_threshold(runs, np.arange(64)) is None


def test_two_low_runs_are_outliers_and_no_population() -> None:
    rng = np.random.default_rng(3)
    response = np.concatenate([[-900, -950], rng.normal(400, 30, 100)])
    assert failure_threshold(response, cases(102)) is None


def test_a_majority_does_not_fail() -> None:
    rng = np.random.default_rng(4)
    response = rng.permuted(np.concatenate([rng.normal(0, 10, 70), rng.normal(500, 100, 30)]))
    assert failure_threshold(response, cases(100)) is None


def test_a_fixed_threshold_is_used_as_it_is() -> None:
    threshold = failure_threshold(np.arange(10.0), np.arange(10), fixed=4.5)
    assert threshold.value == 4.5
    assert 'fixed by the user' in threshold.rule


def test_equal_responses_have_no_gap() -> None:
    assert failure_threshold(np.ones(20), cases(20)) is None


@pytest.mark.parametrize('share', [0.2, 0.4])
def test_failures_are_seen_up_to_a_share_of_two_fifths(share: float) -> None:
    truth = Truth(failure={'1': float(special.logit(share))})
    levels = repeated_levels(fraction('quarter'), 10)
    for seed in range(10):
        response = truth.simulate(levels, np.random.default_rng(seed))
        assert failure_threshold(response, np.repeat(np.arange(32), 10)) is not None


def test_what_the_rule_does_not_call_failure_is_told() -> None:
    rng = np.random.default_rng(4)
    response = rng.permuted(np.concatenate([rng.normal(0, 10, 70), rng.normal(500, 100, 30)]))
    parting = two_groups(response, cases(100))
    assert parting is not None
    (text,) = unseen_caveat(parting, response)
    assert '70 below' in text
    assert '--failure-threshold' in text


def test_strong_effects_and_single_populations_are_not_two_groups() -> None:
    rng = np.random.default_rng(3)
    effect = np.where(cases(320) % 4 == 0, 400, 700) + rng.normal(0, 40, 320)
    assert two_groups(effect, cases(320)) is None
    assert two_groups(rng.normal(size=320), cases(320)) is None
