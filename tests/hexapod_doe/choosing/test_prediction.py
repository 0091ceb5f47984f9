# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hexapod_doe.choosing.prediction import half_widths, predict_all, rank_descending
from hexapod_doe.fitting.regression import Fit, ols
from hexapod_doe.fitting.transform import Transform

DATA = Path(__file__).parents[2] / 'data' / 'doe_cases'
SAFE = np.ones(8, dtype=bool)


@pytest.fixture(scope='module')
def plasma() -> Fit:
    """Montgomery, Example 6.1, the model of A, C and AC."""
    rows = pd.read_csv(DATA / 'plasma_2_3_r2.csv')
    return ols(rows[list('ABC')], rows['y'].to_numpy(float), ('1', 'A', 'C', 'AC'))


def test_published_predictions(plasma: Fit) -> None:
    expected = json.loads((DATA / 'plasma_2_3_r2.json').read_text())['predictions_reduced_95']
    found = predict_all(plasma, 'ABC', None, 0.95, {'A'}, SAFE)
    assert [item.fit for item in found] == pytest.approx(expected['fit'])
    assert [item.se for item in found] == pytest.approx(expected['se'])
    for bound, kind in ((0, 'lo'), (1, 'hi')):
        assert [p.ci[bound] for p in found] == pytest.approx(expected[f'ci_{kind}'], rel=1e-9)
        assert [p.pi[bound] for p in found] == pytest.approx(expected[f'pi_{kind}'], rel=1e-9)
    assert [item.tested for item in found] == [item.label == 'A' for item in found]


def test_the_mean_of_more_runs_is_surer(plasma: Fit) -> None:
    point = np.array([[1.0, 1.0, 1.0, 1.0]])
    one, ten = (half_widths(plasma, point, 0.9, new_runs=runs)[0] for runs in (1, 10))
    assert half_widths(plasma, point, 0.9)[0] < ten < one


def test_bounds_outside_the_transform_do_not_exist() -> None:
    # The way back of power 2 ends at 1/2 (g = 1): the fit of 597 - 559 is above it, its interval
    # of half width 45 is not.
    rows = pd.read_csv(DATA / 'plasma_2_3_r2.csv')
    fit = ols(rows[list('ABC')], rows['y'].to_numpy(float) - 559, ('1', 'A', 'C', 'AC'))
    first = predict_all(fit, 'ABC', Transform('power', 2.0, 0.0, ''), 0.95, set(), SAFE)[0]
    assert first.fit == pytest.approx(np.sqrt(2 * 37 + 1))
    assert first.ci[0] is None
    assert first.ci[1] == pytest.approx(np.sqrt(2 * 82.4185258355559 + 1))


def test_ranks_put_missing_values_last() -> None:
    assert rank_descending(np.array([1.0, np.nan, 3.0, 3.0])).tolist() == [3, 4, 1, 2]
