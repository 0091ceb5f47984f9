# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Unequal spread: found by factor, and allowed for as statsmodels' HC3 and weights would."""

import numpy as np
import pandas as pd
import pytest
from hexapod_doe.designs.design import fraction
from hexapod_doe.fitting.dispersion import covariance_root, dispersion, relative_deviation
from hexapod_doe.fitting.model import corners, estimable_terms, model_matrix
from hexapod_doe.fitting.regression import Fit, ols
from simulated import repeated_levels
from statsmodels.regression.linear_model import OLS

LEVELS = repeated_levels(fraction('quarter'), 5)
TERMS = estimable_terms(LEVELS, 2)


def fit_of(ratio: float, seed: int = 1) -> Fit:
    """A fit of runs whose deviation is 20, and `ratio` times that with C."""
    deviation = np.where(LEVELS['C'] > 0, 20 * ratio, 20)
    noise = np.random.default_rng(seed).normal(0, deviation)
    return ols(LEVELS, 400 + 50 * LEVELS['A'] + noise, TERMS)


def test_a_factor_that_changes_the_spread_is_found() -> None:
    found = dispersion(LEVELS, fit_of(3.0), 0.05)
    assert found is not None
    assert found.active == ('C',)
    assert found.ratio['C'] == pytest.approx(3.0, rel=0.25)


def test_equal_spread_is_left_alone() -> None:
    hits = [dispersion(LEVELS, fit_of(1.0, seed), 0.05) for seed in range(40)]
    assert sum(found is not None and found.active != () for found in hits) <= 5


def test_the_covariance_is_that_of_hc3() -> None:
    fit = fit_of(3.0)
    root = covariance_root(fit, dispersion(LEVELS, fit, 0.05))
    response = fit.fitted + fit.residuals
    reference = OLS(response, model_matrix(LEVELS, fit.terms)).fit(cov_type='HC3')
    assert fit.s**2 * root @ root.T == pytest.approx(np.asarray(reference.cov_params()), abs=1e-6)


def test_the_deviation_of_a_new_run_follows_the_factor() -> None:
    fit, grid = fit_of(3.0), corners('ABCDEFG')
    sigma = fit.s * relative_deviation(grid, LEVELS, fit, dispersion(LEVELS, fit, 0.05))
    assert sigma[grid['C'] > 0] == pytest.approx(np.full(64, 60), rel=0.2)
    assert sigma[grid['C'] < 0] == pytest.approx(np.full(64, 20), rel=0.2)


def test_few_runs_tell_nothing() -> None:
    few = pd.DataFrame(fraction('eighth').levels, columns=list('ABCDEFG'))
    fit = ols(few, np.arange(16.0) ** 1.5, ('1', *'ABCDEFG'))
    assert dispersion(few, fit, 0.05) is None
