# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A fitted step is at hand as statsmodels' own results."""

from functools import cache

import numpy as np
import pytest
from hexapod_doe.analysis.analysis import analyse
from hexapod_doe.designs.design import fraction
from hexapod_doe.errors import AnalysisError
from hexapod_doe.records.options import Options
from hexapod_doe.records.results import Analysis
from simulated import repeated_levels, table_of


@cache
def analysis(blocks: int) -> Analysis:
    levels = repeated_levels(fraction('quarter'), 4)
    noise = np.random.default_rng(1).normal(0, 10, len(levels))
    labels = np.arange(len(levels)) % blocks if blocks else None
    table = table_of(levels, 500 + 30 * levels['C'].to_numpy() + noise, labels)
    return analyse([table], Options(trim_worst=1))


@pytest.mark.parametrize('blocks', [0, 4])
@pytest.mark.parametrize('name', ['initial', 'final'])
def test_a_model_has_the_numbers_of_its_step(name: str, blocks: int) -> None:
    found = analysis(blocks)
    step = found.final if name == 'final' else found.steps[0]
    model = found.model(name)
    for term in step.terms:
        assert model.params[term] == pytest.approx(step.coef[term], rel=1e-9)
        assert model.bse[term] == pytest.approx(step.se[term], rel=1e-9)
        assert model.pvalues[term] == pytest.approx(step.p[term], rel=1e-6)
    assert int(model.nobs) == step.n
    assert model.rsquared == pytest.approx(step.r2, rel=1e-9)
    assert 'reward' in str(model.summary())


def test_an_unknown_step_is_named() -> None:
    with pytest.raises(AnalysisError, match="no step 'last', expected one of initial"):
        analysis(0).model('last')
