# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Fits, predictions and PRESS of random tables against statsmodels' plain least squares.

The tables have lost rows, unequal replicates, centre points and blocks by turns. The reference is
`OLS` on the response as it is, with columns multiplied out here and indicators of blocks that sum
to zero; the product fits a centred response and takes the blocks out.
"""

import numpy as np
import pandas as pd
import pytest
from hexapod_doe.choosing.prediction import half_widths
from hexapod_doe.designs.design import factor_letters, fraction
from hexapod_doe.fitting.blocks import block_basis
from hexapod_doe.fitting.model import corners, estimable_terms, model_matrix
from hexapod_doe.fitting.regression import ols
from statsmodels.regression.linear_model import OLS
from statsmodels.stats.outliers_influence import OLSInfluence

TABLES = 200
LEVEL = 0.9


class RandomTable:
    """A table drawn by its number."""

    def __init__(self, number: int) -> None:
        rng = np.random.default_rng([20261130, number])
        count = int(rng.integers(3, 8))
        kind = 'full' if count < 5 else str(rng.choice(['half', 'full']))
        letters = factor_letters(count)
        design = np.asarray(fraction(kind, count).levels, float)
        runs = rng.integers(1, 5, len(design))
        rows = np.repeat(design, runs, axis=0)
        if number % 3 == 0:
            rows = np.vstack([rows, np.zeros((int(rng.integers(2, 5)), count))])
        kept = np.sort(rng.permutation(len(rows))[: int(len(rows) * rng.uniform(0.9, 1))])
        self.levels = pd.DataFrame(rows[kept], columns=list(letters))
        self.blocks = rng.integers(0, 3, len(kept)) if number % 4 == 0 else None
        effect = self.levels.to_numpy() @ rng.normal(0, 30, count)
        self.response = rng.uniform(-500, 3000) + effect + rng.normal(0, 50, len(kept))
        basis = None if self.blocks is None else block_basis(self.blocks)
        self.terms = estimable_terms(self.levels, 2, basis)
        self.fit = ols(self.levels, self.response, self.terms, basis)
        columns = self.columns(self.levels)
        if self.blocks is not None:
            indicator = pd.get_dummies(self.blocks).to_numpy(float)
            columns = np.column_stack([columns, indicator[:, :-1] - indicator[:, -1:]])
        self.reference = OLS(self.response, columns).fit()

    def columns(self, levels: pd.DataFrame) -> np.ndarray:
        """Products of levels; curvature is 1 at the corners and 0 at a centre point."""
        built = []
        for term in self.terms:
            if term == 'curvature':
                built.append(model_matrix(levels, [term])[:, 0])
            else:
                built.append(levels[list(term.replace('1', ''))].prod(axis=1).to_numpy(float))
        return np.column_stack(built)


def same(found: object, expected: object) -> bool:
    return found == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize('start', range(0, TABLES, 20))
def test_fit_prediction_and_press_are_those_of_statsmodels(start: int) -> None:
    for table in map(RandomTable, range(start, start + 20)):
        fit, reference, size = table.fit, table.reference, len(table.terms)
        assert fit.df_error == reference.df_resid > 0
        for found, expected in (
            (fit.coef, reference.params),
            (fit.se, reference.bse),
            (fit.t, reference.tvalues),
            (fit.p, reference.pvalues),
        ):
            assert same(found, expected[:size])
        assert same(fit.sse, reference.ssr)
        assert same(fit.sst, reference.centered_tss)
        assert same(fit.r2, reference.rsquared)
        assert same(fit.r2_adj, reference.rsquared_adj)
        if fit.press is not None:
            deleted = OLSInfluence(reference).resid_press
            assert same(fit.press, float((deleted**2).sum()))
        if table.blocks is None:
            check_predictions(table)


def check_predictions(table: RandomTable) -> None:
    grid = corners(list(table.levels.columns))
    points = model_matrix(grid, table.terms)
    expected = table.reference.get_prediction(table.columns(grid)).summary_frame(1 - LEVEL)
    assert same(points @ table.fit.coef, expected['mean'].to_numpy())
    for new_runs, name in ((None, 'mean_ci_lower'), (1, 'obs_ci_lower')):
        half = half_widths(table.fit, points, LEVEL, new_runs)
        assert same(half, (expected['mean'] - expected[name]).to_numpy())
