# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hexapod_doe.fitting.blocks import block_basis
from hexapod_doe.fitting.elimination import eliminate
from hexapod_doe.fitting.model import (
    AliasedTermsError,
    corners,
    estimable_terms,
    model_matrix,
)
from hexapod_doe.fitting.regression import ols

DATA = Path(__file__).parents[2] / 'data' / 'doe_cases'
TERMS = ('1', 'A', 'B', 'AB')


@pytest.fixture
def chemical() -> tuple[pd.DataFrame, np.ndarray, np.ndarray]:
    """Montgomery, Example 7.1: a 2^2 in three blocks, each a batch of raw material."""
    yields = [28, 36, 18, 31, 25, 32, 19, 30, 27, 32, 23, 29]
    levels = pd.concat([corners('AB')] * 3, ignore_index=True)
    return levels, np.array(yields, dtype=float), np.repeat(['I', 'II', 'III'], 4)


def unbalanced() -> tuple[pd.DataFrame, np.ndarray, np.ndarray]:
    """A 2^3 in four blocks of different size with rows missing."""
    rng = np.random.default_rng(1)
    kept = np.sort(rng.choice(32, 26, replace=False))
    levels = pd.concat([corners('ABC')] * 4, ignore_index=True).iloc[kept]
    return levels.reset_index(drop=True), rng.normal(100, 10, 26), rng.integers(0, 4, 26)


def test_a_factorial_in_blocks_as_printed(
    chemical: tuple[pd.DataFrame, np.ndarray, np.ndarray],
) -> None:
    # Its analysis of variance: blocks 6.50, A 208.33, B 75.00, AB 8.33, error 24.84 on 6 degrees
    # of freedom; F of A 50.32, of B 18.12, of AB 2.01.
    levels, y, batch = chemical
    fit = ols(levels, y, TERMS, block_basis(batch))
    squares = dict(zip(fit.terms, 12 * fit.coef**2, strict=True))
    assert fit.blocks is not None
    assert (fit.blocks.ss, fit.blocks.df) == (pytest.approx(6.50), 2)
    assert squares['A'] == pytest.approx(208.33, abs=0.005)
    assert squares['B'] == pytest.approx(75.00, abs=0.005)
    assert squares['AB'] == pytest.approx(8.33, abs=0.005)
    assert (fit.sse, fit.df_error) == (pytest.approx(24.84, abs=0.01), 6)
    assert fit.t[1:] ** 2 == pytest.approx([50.32, 18.12, 2.01], abs=0.02)
    # The book prints no F for blocks; (6.50/2)/(24.84/6).
    assert fit.blocks.f == pytest.approx(0.785, abs=0.001)


def test_a_block_generator_hides_its_interaction() -> None:
    # Montgomery, Example 7.2: the filtration data with 20 less in the block where ABCD is +1.
    # Its analysis of variance: blocks 1387.5625; A 1870.5625, C 390.0625, D 855.5625,
    # AC 1314.0625, AD 1105.5625; error 187.5625 on 9 degrees of freedom, of a total of 7110.9375.
    rows = pd.read_csv(DATA / 'filtration_2_4.csv')
    levels = rows[list('ABCD')]
    block = levels.prod(axis=1).to_numpy()
    y = rows['y'].to_numpy(float) - np.where(block > 0, 20, 0)
    fit = ols(levels, y, ('1', 'A', 'C', 'D', 'AC', 'AD'), block_basis(block))
    assert 16 * fit.coef[1:] ** 2 == pytest.approx(
        [1870.5625, 390.0625, 855.5625, 1314.0625, 1105.5625]
    )
    assert fit.blocks is not None
    assert (fit.blocks.ss, fit.sse, fit.df_error) == pytest.approx((1387.5625, 187.5625, 9))
    assert fit.sst == pytest.approx(7110.9375)
    assert 'ABCD' not in estimable_terms(levels, blocks=block_basis(block))
    with pytest.raises(AliasedTermsError, match='cannot tell ABCD from the differences between'):
        ols(levels, y, ('1', 'A', 'ABCD'), block_basis(block))


def test_blocks_are_columns_of_the_model() -> None:
    levels, y, block = unbalanced()
    fit = ols(levels, y, ('1', 'A', 'B', 'C', 'AC'), block_basis(block))
    indicator = np.eye(4)[block]
    dummies = indicator[:, :-1] - indicator[:, -1:]
    matrix = np.column_stack([model_matrix(levels, fit.terms), dummies])
    coef, (sse,), *_ = np.linalg.lstsq(matrix, y)
    covariance = np.linalg.inv(matrix.T @ matrix) * sse / (26 - 5 - 3)
    assert fit.coef == pytest.approx(coef[:5], rel=1e-10)
    assert fit.sse == pytest.approx(sse, rel=1e-10)
    assert fit.covariance() == pytest.approx(covariance[:5, :5], rel=1e-9)
    assert fit.fitted == pytest.approx(matrix @ coef, rel=1e-10)
    assert fit.leverage == pytest.approx(np.diag(matrix @ np.linalg.pinv(matrix)), rel=1e-9)


@pytest.mark.parametrize('whole_cases', [False, True])
def test_press_leaves_out_rows_or_cases_of_blocks(whole_cases: bool) -> None:
    levels, y, block = unbalanced()
    terms = ('1', 'A', 'B', 'C')
    matrix = np.column_stack([model_matrix(levels, terms), np.eye(4)[block][:, 1:]])
    case = levels.groupby(list('ABC')).ngroup().to_numpy() if whole_cases else np.arange(26)
    expected = 0.0
    for number in np.unique(case):
        out = case == number
        coef = np.linalg.lstsq(matrix[~out], y[~out])[0]
        expected += ((y[out] - matrix[out] @ coef) ** 2).sum()
    fit = ols(levels, y, terms, block_basis(block))
    found = fit.press_cases if whole_cases else fit.press
    assert found == pytest.approx(expected, rel=1e-9)


def test_pure_error_is_free_of_blocks() -> None:
    levels, y, block = unbalanced()
    fit = ols(levels, y, ('1', 'A'), block_basis(block))
    cells = np.column_stack([model_matrix(levels, estimable_terms(levels)), np.eye(4)[block]])
    rest = y - cells @ np.linalg.lstsq(cells, y)[0]
    lack = fit.lack_of_fit
    assert lack is not None
    assert lack.ss_pure_error == pytest.approx(rest @ rest)
    assert lack.df_pure_error == 26 - np.linalg.matrix_rank(cells)
    assert lack.df_lack_of_fit + lack.df_pure_error == fit.df_error


def test_elimination_agrees_with_refits_in_blocks() -> None:
    levels, y, block = unbalanced()
    basis = block_basis(block)
    y = y + 30 * levels['A'].to_numpy() + 50 * block
    kept, trace = eliminate(levels, y, estimable_terms(levels, 2), blocks=basis)
    assert 'A' in kept
    terms = list(estimable_terms(levels, 2))
    for item in trace:
        before = ols(levels, y, terms, basis)
        assert item.p == pytest.approx(before.p[before.terms.index(item.term)], rel=1e-9)
        terms.remove(item.term)
        after = ols(levels, y, terms, basis)
        assert (item.s, item.r2, item.r2_adj) == pytest.approx((after.s, after.r2, after.r2_adj))


def test_one_block_is_none() -> None:
    levels, y, _ = unbalanced()
    plain, blocked = ols(levels, y, TERMS), ols(levels, y, TERMS, block_basis(np.zeros(26)))
    assert (blocked.sse, blocked.df_error, blocked.blocks) == (plain.sse, plain.df_error, None)
