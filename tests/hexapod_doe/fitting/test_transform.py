# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import json
from decimal import Decimal, localcontext
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hexapod_doe.errors import AnalysisError
from hexapod_doe.fitting.model import corners, model_matrix
from hexapod_doe.fitting.regression import ols
from hexapod_doe.fitting.transform import (
    Transform,
    choose_transform,
    profile,
    profile_lambda,
    shift_for,
)
from statsmodels.regression.linear_model import OLS

CASES = Path(__file__).parents[2] / 'data' / 'cases'
CHECKS = json.loads(
    (Path(__file__).parents[2] / 'data' / 'doe_cases' / 'formula_checks.json').read_text()
)


def transform(lambda_: float, shift: float = 0.0, scale: float = 1.0) -> Transform:
    return Transform('power', lambda_, shift, '', scale)


@pytest.mark.parametrize('lambda_', [-1.0, -0.5, 0.0, 0.5, 1.0, 2.5])
def test_the_way_back_is_the_inverse(lambda_: float) -> None:
    y = np.array([-1.5, 0.2, 3.0, 40.0])
    there = transform(lambda_, shift=2.0, scale=3.0)
    assert there.inverse(there.forward(y)) == pytest.approx(y, rel=1e-9)


def test_below_the_domain_there_is_no_way_back() -> None:
    assert np.isnan(transform(2.0).inverse(np.array([0.4]))).all()


def test_second_order_mean_and_slope() -> None:
    # STATS: lambda 2, eta 50, sigma 8: median 10.0499, mean 10.0183.
    expected = CHECKS['back_transform_example']
    found = transform(2.0)
    eta = 1 + np.array([expected['eta']])  # the reference leaves out g, which is 1 here
    assert found.inverse(eta)[0] == pytest.approx(expected['point_back_transformed'])
    assert found.mean(eta, expected['sigma'])[0] == pytest.approx(expected['second_order_mean'])
    assert found.slope(eta)[0] == pytest.approx(expected['g_prime'])


def test_the_mean_of_a_log_normal() -> None:
    assert transform(0.0).mean(np.array([2.0]), 0.5)[0] == pytest.approx(np.exp(1.125))


def test_lambda_is_found_given_the_model() -> None:
    rng = np.random.default_rng(8)
    levels = corners('ABCDE')
    matrix = model_matrix(levels, ['1', 'A', 'B', 'AB'])
    root = matrix @ [20.0, 5.0, -3.0, 2.0] + rng.normal(0, 0.5, 32)
    found = choose_transform('boxcox', root**2, matrix)
    assert found.lambda_ == 0.5
    assert found.lambda_ci[0] < 0.5 < found.lambda_ci[1]
    limit = profile(root**2, matrix)(found.lambda_hat) - 1.920729410347062  # chi2_1(0.95)/2
    for bound in found.lambda_ci:
        assert profile(root**2, matrix)(bound) == pytest.approx(limit, abs=1e-6)


def test_the_likelihood_is_the_gaussian_one_with_its_jacobian() -> None:
    rng = np.random.default_rng(9)
    y = rng.lognormal(1, 0.4, 16)
    matrix = model_matrix(corners('ABCD'), ['1', 'A'])
    log_likelihood = profile(y, matrix)

    def direct(power: float) -> float:
        z = (y**power - 1) / power
        rest = z - matrix @ np.linalg.lstsq(matrix, z)[0]
        return -8 * np.log(rest @ rest / 16) + (power - 1) * np.log(y).sum()

    assert log_likelihood(0.7) - log_likelihood(-1.3) == pytest.approx(direct(0.7) - direct(-1.3))


def test_negative_responses_are_shifted_by_rule() -> None:
    assert shift_for(np.array([1.0, 5.0])) == 0
    assert shift_for(np.array([-4.0, 6.0])) == pytest.approx(4.5)


def test_nothing_to_judge_lambda_by() -> None:
    matrix = model_matrix(corners('AB'), ['1', 'A', 'B', 'AB'])
    with pytest.raises(AnalysisError, match='degrees of freedom'):
        choose_transform('boxcox', np.arange(1.0, 5.0), matrix)


@pytest.mark.parametrize('name', ['sqrt', 'power:', 'power:x', 'power:nan', 'power:inf'])
def test_unknown_transforms(name: str) -> None:
    with pytest.raises(AnalysisError, match='transform'):
        choose_transform(name, np.ones(4), np.ones((4, 1)))


@pytest.mark.parametrize('lambda_', [-30.0, -5.0, -3.0, 0.0, 5.0, 30.0])
def test_any_power_keeps_the_digits_of_returns_near_3500(lambda_: float) -> None:
    rows = pd.read_csv(CASES / 'F5_boxcox_returns3500.csv')
    y, levels = rows['y'].to_numpy(float), rows[list('ABC')]
    terms = ('1', 'A', 'B', 'AB')
    there = choose_transform(f'power:{lambda_}', y, model_matrix(levels, terms))
    assert there is not None
    assert there.inverse(there.forward(y)) == pytest.approx(y, rel=1e-12)
    # The same power by exact rational and 60-digit arithmetic; R² has no unit.
    with localcontext(prec=60):
        plain = [Decimal(v) ** int(lambda_) if lambda_ else Decimal(v).ln() for v in y]
        low, high = min(plain), max(plain)
        exact = np.array([float((v - low) / (high - low)) for v in plain])
    reference = OLS(exact, model_matrix(levels, terms)).fit().rsquared
    assert ols(levels, there.forward(y), terms).r2 == pytest.approx(reference, abs=1e-9)


def test_a_power_beyond_the_digits_is_refused() -> None:
    y = pd.read_csv(CASES / 'F5_boxcox_returns3500.csv')['y'].to_numpy(float)
    with pytest.raises(AnalysisError, match='choose a power nearer to 1'):
        choose_transform('power:-3000', y, np.ones((len(y), 1)))


def test_lambda_stays_within_its_bounds() -> None:
    y = np.array([1.0, 1.1, 1.2, 100.0])
    assert abs(profile_lambda(y, np.ones((4, 1)))) <= 5
