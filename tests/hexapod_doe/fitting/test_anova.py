# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The analysis of variance against statsmodels' type III table, on unequal runs."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hexapod_doe.fitting.anova import anova, vif
from hexapod_doe.fitting.regression import ols
from statsmodels.formula.api import ols as formula_fit
from statsmodels.stats.anova import anova_lm
from statsmodels.stats.outliers_influence import variance_inflation_factor

CASES = Path(__file__).parents[2] / 'data' / 'cases'


def test_adjusted_sums_of_squares_are_those_of_type_three() -> None:
    rows = pd.read_csv(CASES / 'F7_unbalanced_main_effects.csv')
    fit = ols(rows[['A', 'B']], rows['y'], ('1', 'A', 'B', 'AB'))
    table = {row.source: row for row in anova(fit)}
    reference = anova_lm(formula_fit('y ~ A*B', rows).fit(), typ=3)
    for ours, theirs in (('A', 'A'), ('B', 'B'), ('AB', 'A:B')):
        assert table[ours].ss == pytest.approx(reference['sum_sq'][theirs])
        assert table[ours].p == pytest.approx(reference['PR(>F)'][theirs])
    assert table['error'].ss == pytest.approx(reference['sum_sq']['Residual'])
    assert table['total'].df == len(rows) - 1


def test_groups_are_tested_together() -> None:
    rows = pd.read_csv(CASES / 'F7_unbalanced_main_effects.csv')
    fit = ols(rows[['A', 'B']], rows['y'], ('1', 'A', 'B', 'AB'))
    table = {row.source: row for row in anova(fit)}
    whole = formula_fit('y ~ A*B', rows).fit()
    f, p, df = whole.compare_f_test(formula_fit('y ~ A:B', rows).fit())
    assert (table['main effects'].f, table['main effects'].p) == pytest.approx((f, p))
    assert table['main effects'].df == df
    assert table['model'].f == pytest.approx(whole.fvalue)


def test_the_parts_of_the_error_add_up() -> None:
    rows = pd.read_csv(CASES / 'F2_curvature_unequal.csv')
    table = {row.source: row for row in anova(ols(rows[['A', 'B']], rows['y'], ('1', 'A', 'B')))}
    lack, pure = table['lack of fit'], table['pure error']
    assert lack.ss + pure.ss == pytest.approx(table['error'].ss)
    assert lack.df + pure.df == table['error'].df


def test_curvature_and_blocks_have_their_rows() -> None:
    rows = pd.read_csv(CASES / 'F2_curvature_unequal.csv')
    fit = ols(rows[['A', 'B']], rows['y'], ('1', 'A', 'B', 'curvature'))
    assert [row.source for row in anova(fit)][:5] == [
        'model', 'main effects', 'A', 'B', 'curvature',
    ]  # fmt: skip


def test_variance_inflation() -> None:
    rows = pd.read_csv(CASES / 'F7_unbalanced_main_effects.csv')
    fit = ols(rows[['A', 'B']], rows['y'], ('1', 'A', 'B', 'AB'))
    exog = np.column_stack([np.ones(len(rows)), rows['A'], rows['B'], rows['A'] * rows['B']])
    expected = [variance_inflation_factor(exog, i) for i in (1, 2, 3)]
    assert list(vif(fit).values()) == pytest.approx(expected)


def test_a_saturated_fit_has_no_table() -> None:
    levels = pd.DataFrame({'A': [-1, 1, -1, 1], 'B': [-1, -1, 1, 1]})
    assert anova(ols(levels, np.array([1.0, 2.0, 4.0, 9.0]), ('1', 'A', 'B', 'AB'))) == ()
