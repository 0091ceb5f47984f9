# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The simulation agrees with the formula where it holds, and shows what failures cost."""

import pytest
from hexapod_doe.designs.aliases import representatives
from hexapod_doe.designs.design import fraction
from hexapod_doe.designs.power import power
from hexapod_doe.designs.power_simulation import RunModel, simulate_power

QUARTER = fraction('quarter')


def _simulate(terms, effect, replicates, model, **options):
    return simulate_power(
        QUARTER.levels, QUARTER.factors, terms, effect, replicates, model, **options
    )


def test_without_failures_it_agrees_with_the_formula():
    result = _simulate(list('ABCDEFG'), 1.0, 1, RunModel(), repeats=20000)
    assert abs(result.power - power(1.0, 32, 8)) < 4 * result.power_se
    assert result.false_alarms == pytest.approx(0.05, abs=0.002)


def test_failing_runs_cost_far_more_power_than_the_formula_says():
    # 20 % of the runs fail and lose ten standard deviations: the mixture's deviation is
    # sqrt(.8 40^2 + .2 60^2 + .16 400^2) = 166.1, and the effect on the mean shrinks to 0.8 * 60.
    model = RunModel(sigma=40, failure=0.2, loss=400, failure_sigma=60)
    terms = representatives(QUARTER.levels, QUARTER.factors, 2)
    result = _simulate(terms, 60, 10, model)
    assert power(60, 320, 26, sigma=40) > 0.999
    assert result.power == pytest.approx(power(0.8 * 60, 320, 26, sigma=166.132), abs=0.04)
    assert result.false_alarms == pytest.approx(0.05, abs=0.01)


def test_the_same_seed_gives_the_same_campaigns():
    model = RunModel(failure=0.1, loss=3)
    first, again, other = (
        _simulate(['A', 'B'], 0.5, 2, model, repeats=200, seed=seed) for seed in (3, 3, 4)
    )
    assert first == again != other


def test_impossible_questions_are_named():
    with pytest.raises(ValueError, match=r'failure 1\.0: expected a probability'):
        RunModel(failure=1.0)
    with pytest.raises(ValueError, match='sigma 0: expected'):
        RunModel(sigma=0)
    terms = representatives(QUARTER.levels, QUARTER.factors, 3)
    with pytest.raises(ValueError, match='32 runs, 32 parameters'):
        _simulate(terms, 1.0, 1, RunModel())
