# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import numpy as np
import pandas as pd
import pytest
from hexapod_doe.designs.design import factor_letters, fraction, from_generators
from hexapod_doe.errors import AnalysisError
from hexapod_doe.fitting.curvature import curvature
from hexapod_doe.fitting.elimination import eliminate
from hexapod_doe.fitting.model import corners, estimable_terms, model_matrix
from hexapod_doe.fitting.regression import ols
from hypothesis import given
from hypothesis import strategies as st


def random_table(rng: np.random.Generator, replicates: int = 3) -> tuple[pd.DataFrame, np.ndarray]:
    design = fraction('half', 5)
    levels = pd.DataFrame(np.repeat(design.levels, replicates, axis=0), columns=list('ABCDE'))
    return levels, rng.normal(500, 80, len(levels))


@st.composite
def random_fractions(draw: st.DrawFn) -> pd.DataFrame:
    """Draw regular fractions of 3 to 6 factors with random generators, run two or three times."""
    count = draw(st.integers(3, 6))
    letters = factor_letters(count)
    base = letters[: draw(st.integers(2, count))]
    words = st.sets(st.sampled_from(base), min_size=1).map(lambda word: ''.join(sorted(word)))
    generators = ','.join(f'{letter}={draw(words)}' for letter in letters[len(base) :])
    levels = from_generators(generators, count).levels
    repeated = np.repeat(levels, draw(st.integers(2, 3)), axis=0)
    return pd.DataFrame(repeated, columns=list(letters))


@given(random_fractions(), st.integers(1, 3))
def test_every_run_and_every_corner_of_a_fraction_has_the_leverage_p_over_n(
    levels: pd.DataFrame, max_order: int
) -> None:
    fit = ols(levels, np.arange(len(levels)) ** 1.5, estimable_terms(levels, max_order))
    share = len(fit.terms) / len(levels)
    assert fit.leverage == pytest.approx(np.full(len(levels), share))
    points = model_matrix(corners(list(levels.columns)), fit.terms)
    assert fit.unscaled_variance(points) == pytest.approx(np.full(len(points), share))


@given(random_fractions(), st.integers(1, 2), st.integers(0, 999))
def test_press_is_the_explicit_leave_one_out(
    levels: pd.DataFrame, max_order: int, seed: int
) -> None:
    y = np.random.default_rng(seed).normal(500, 80, len(levels))
    terms = estimable_terms(levels, max_order)
    matrix = model_matrix(levels, terms)
    expected = 0.0
    for row in range(len(y)):
        rest = np.arange(len(y)) != row
        coef = np.linalg.lstsq(matrix[rest], y[rest])[0]
        expected += (y[row] - matrix[row] @ coef) ** 2
    assert ols(levels, y, terms).press == pytest.approx(expected, rel=1e-10)


def test_press_cases_is_the_explicit_leave_one_case_out() -> None:
    levels, y = random_table(np.random.default_rng(2))
    levels, y = levels.iloc[1:], y[1:]  # unequal replicates
    terms = ('1', 'A', 'B', 'AB')
    matrix = model_matrix(levels, terms)
    case = levels.groupby(list('ABCDE')).ngroup().to_numpy()
    expected = 0.0
    for number in range(case.max() + 1):
        out = case == number
        coef = np.linalg.lstsq(matrix[~out], y[~out])[0]
        expected += ((y[out] - matrix[out] @ coef) ** 2).sum()
    assert ols(levels, y, terms).press_cases == pytest.approx(expected, rel=1e-10)


def test_press_of_a_balanced_design() -> None:
    # Every h is p/N, so that PRESS = SSE/(1 - p/N)^2: 1.05194 for N = 320, p = 8.
    design = fraction('quarter')
    levels = pd.DataFrame(np.repeat(design.levels, 10, axis=0), columns=list('ABCDEFG'))
    y = np.random.default_rng(3).normal(size=320)
    fit = ols(levels, y, ('1', *'ABCDEFG'))
    assert fit.press / fit.sse == pytest.approx(1.051939513477975, rel=1e-12)


def test_every_corner_of_an_orthogonal_design_has_the_same_variance() -> None:
    levels, y = random_table(np.random.default_rng(4))
    fit = ols(levels, y, ('1', 'A', 'B', 'C', 'AB'))
    q = fit.unscaled_variance(model_matrix(corners('ABCDE'), fit.terms))
    assert q == pytest.approx(np.full(32, 5 / 48))


def test_a_saturated_fit_has_no_error() -> None:
    levels, y = random_table(np.random.default_rng(5), replicates=1)
    fit = ols(levels, y, estimable_terms(levels))
    assert fit.r2 == pytest.approx(1)
    assert (fit.s, fit.p, fit.press, fit.press_cases, fit.r2_adj, fit.r2_pred) == (None,) * 6
    assert fit.lack_of_fit is None
    with pytest.raises(AnalysisError, match='saturated'):
        fit.covariance()


def test_large_responses_lose_no_digits() -> None:
    levels, y = random_table(np.random.default_rng(6))
    small = ols(levels, y, ('1', 'A', 'BC'))
    large = ols(levels, 1e9 + 1e6 * y, ('1', 'A', 'BC'))
    assert large.p[1:] == pytest.approx(small.p[1:], rel=1e-6)
    assert large.r2 == pytest.approx(small.r2, rel=1e-9)


def test_curvature_needs_centre_points() -> None:
    levels = pd.DataFrame({'A': [-1, 1, -1, 1], 'B': [-1, -1, 1, 1]})
    assert curvature(levels, np.arange(4.0)) is None


def test_curvature_without_pure_error_has_no_test() -> None:
    levels = pd.DataFrame({'A': [-1, 1, -1, 1, 0], 'B': [-1, -1, 1, 1, 0]})
    bend = curvature(levels, np.array([1.0, 2.0, 3.0, 4.0, 5.0]))
    # (2.5 - 5)^2 * 4 * 1 / 5
    assert (bend.difference, bend.ss) == pytest.approx((-2.5, 5.0))
    assert bend.p is None


def test_an_offset_costs_no_digits() -> None:
    levels, response = random_table(np.random.default_rng(5))
    terms = estimable_terms(levels, 2)
    plain, far = ols(levels, response, terms), ols(levels, response + 1e12, terms)
    # A number near 1e12 has steps of 1.2e-4.
    assert far.coef[1:] == pytest.approx(plain.coef[1:], abs=1e-3)
    assert far.s == pytest.approx(plain.s, rel=1e-5)


@pytest.mark.parametrize(
    ('factor', 'offset', 'message'),
    [(1e-16, 1.0, 'do not resolve'), (1e200, 0.0, 'another unit'), (1e-200, 0.0, 'another unit')],
)
def test_a_response_without_digits_is_refused(factor: float, offset: float, message: str) -> None:
    levels, response = random_table(np.random.default_rng(5))
    with pytest.raises(AnalysisError, match=message):
        ols(levels, response * factor + offset, ('1', 'A'))


def test_rounding_is_no_effect() -> None:
    levels, _ = random_table(np.random.default_rng(5))
    exact = 300 + 80 * levels['C'].to_numpy(float)
    kept, _ = eliminate(levels, exact, estimable_terms(levels, 2))
    assert kept == ('1', 'C')
