# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Curvature at centre points against statsmodels' formulas and R (lm), on data that misled it."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hexapod_doe.analysis.analysis import analyse
from hexapod_doe.choosing.averaging import average
from hexapod_doe.fitting.blocks import block_basis
from hexapod_doe.fitting.curvature import Curvature, curvature
from hexapod_doe.modelling.pipeline import run
from hexapod_doe.records.options import Options
from hexapod_doe.records.results import Analysis
from hexapod_doe.tables.csv_table import read_csv
from statsmodels.formula.api import ols as formula_fit
from statsmodels.regression.linear_model import RegressionResults

CASES = Path(__file__).parents[2] / 'data' / 'cases'


def rows_of(name: str) -> pd.DataFrame:
    rows = pd.read_csv(CASES / f'{name}.csv')
    return rows.assign(centre=(rows['A'] == 0).astype(int)) if 'A' in rows else rows


def found(name: str, factors: str, blocks: str = '') -> Curvature:
    rows = rows_of(name)
    basis = block_basis(rows[blocks].to_numpy()) if blocks else None
    bend = curvature(rows[list(factors)], rows['y'].to_numpy(float), basis)
    assert bend is not None
    return bend


def agree(bend: Curvature, reference: RegressionResults) -> None:
    assert bend.p == pytest.approx(reference.pvalues['centre'], rel=1e-6)
    assert bend.difference == pytest.approx(-reference.params['centre'], rel=1e-9)
    assert bend.df_error == reference.df_resid


def test_curvature_is_judged_within_blocks() -> None:
    bend = found('F1_curvature_blocks', 'AB', 'day')
    agree(bend, formula_fit('y ~ A*B + centre + C(day)', rows_of('F1_curvature_blocks')).fit())
    assert bend.p == pytest.approx(3e-10, rel=0.1)  # R 4.3, lm and anova


def test_unequal_replicates_make_no_curvature() -> None:
    bend = found('F2_curvature_unequal', 'AB')
    agree(bend, formula_fit('y ~ A*B + centre', rows_of('F2_curvature_unequal')).fit())
    assert bend.p > 0.7


def test_switches_stay_in_the_model_of_the_centre() -> None:
    bend = found('80_center_partial', 'ABCD')
    agree(bend, formula_fit('y ~ A*B*C*D + centre', rows_of('80_center_partial')).fit())


def analysis_of(name: str) -> Analysis:
    return analyse(read_csv(CASES / f'{name}.csv', 'y'), Options())


@pytest.mark.parametrize(
    ('one', 'other', 'names'),
    [
        ('75_CP_factors', '75b_AB_factors', {'C': 'A', 'P': 'B'}),
        ('F4_curvature_factor_C', 'F4_curvature_factor_D', {'C': 'D'}),
    ],
)
def test_models_do_not_depend_on_the_names_of_factors(
    one: str, other: str, names: dict[str, str]
) -> None:
    first, second = (analysis_of(name).final for name in (one, other))
    renamed = {''.join(names.get(x, x) for x in t) if t.isupper() else t: t for t in first.terms}
    assert tuple(renamed) == second.terms
    assert [first.p[term] for term in renamed.values()] == pytest.approx(list(second.p.values()))


def test_lenth_judges_contrasts_of_the_factorial_runs_only() -> None:
    table = read_csv(CASES / 'F3_lenth_one_centre.csv', 'y')[0]
    corners = table.rows[table.levels.ne(0).all(axis=1)]
    reference = formula_fit('response ~ A*B*C*D', corners).fit()
    sizes = 2 * reference.params.drop('Intercept').abs()
    first = 1.5 * sizes.median()  # Lenth (1989): s0, then the PSE from those below 2.5 s0
    lenth = run(table, Options()).lenth
    assert lenth is not None
    assert lenth.pse == pytest.approx(1.5 * sizes[sizes < 2.5 * first].median())
    assert lenth.df == 5


def test_averaging_keeps_curvature() -> None:
    rows = rows_of('F9_averaging_curvature')
    result = average(
        rows[list('ABDE')],
        rows['y'].to_numpy(float),
        lambda eta: eta,
        0.99,
        np.random.default_rng(1),
    )
    low, high = result.predictions['(none)'].ci
    assert low is not None
    assert high is not None
    assert low < 91 < high < 94  # 91 is the truth of the simulated runs; centre points reach 130


def test_curvature_is_told() -> None:
    told = [text for text in analysis_of('F9_averaging_curvature').caveats if 'curvature' in text]
    assert len(told) == 1
    assert 'centre points lie 29.8 above' in told[0]
