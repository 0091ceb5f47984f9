# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hexapod_doe.fitting.model import estimable_terms
from hexapod_doe.fitting.regression import ols
from hexapod_doe.modelling.steps import main_effects
from hexapod_doe.tables.csv_table import read_csv
from statsmodels.formula.api import ols as formula_fit

CASES = Path(__file__).parents[2] / 'data' / 'cases'


def test_main_effects_are_fitted_means_where_cases_have_unequal_runs() -> None:
    (table,) = read_csv(CASES / 'F7_unbalanced_main_effects.csv', 'y')
    found = {e.factor: e for e in main_effects(table, ols(
        table.levels, table.values, estimable_terms(table.levels)
    ))}  # fmt: skip
    reference = formula_fit('response ~ A*B', table.rows).fit()
    # The difference of raw means is 14.5, and B's: A does 0.2.
    assert found['A'].mean_with - found['A'].mean_without == pytest.approx(14.5, abs=0.1)
    assert found['A'].effect == pytest.approx(2 * reference.params['A'])
    assert found['A'].se_effect == pytest.approx(2 * reference.bse['A'])
    means = reference.predict(pd.DataFrame({'A': [1, 1], 'B': [-1, 1]}))
    assert found['A'].fitted_with == pytest.approx(means.mean())
    covariance = np.asarray(reference.cov_params())
    point = np.array([1, 1, 0, 0])  # 1, A, B, AB: B averaged out
    assert found['A'].se_fitted_with == pytest.approx(np.sqrt(point @ covariance @ point))


def test_a_factor_outside_the_named_terms_gets_its_mean_too() -> None:
    (table,) = read_csv(CASES / 'F7_unbalanced_main_effects.csv', 'y')
    found = main_effects(table, ols(table.levels, table.values, ('1', 'B')))
    reference = formula_fit('response ~ A + B', table.rows).fit()
    assert found[0].effect == pytest.approx(2 * reference.params['A'])
