# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

from itertools import product

import numpy as np
import pandas as pd
import pytest
from hexapod_doe.choosing.averaging import ModelSpace, average
from hexapod_doe.designs.design import fraction
from hexapod_doe.fitting.model import AliasedTermsError, corners
from hexapod_doe.fitting.regression import ols
from simulated import repeated_levels


def test_the_weights_are_those_of_the_enumerated_models() -> None:
    rng = np.random.default_rng(1)
    levels = pd.concat([corners('ABC')] * 3, ignore_index=True)
    y = 5 + 0.5 * levels['A'].to_numpy() + 0.4 * levels['B'].to_numpy() + rng.normal(size=24)
    space = ModelSpace(levels, y)
    models = [np.array(bits) for bits in product([False, True], repeat=6)]
    scores = np.array([space.score(model) for model in models])
    weights = np.exp(scores - scores.max())
    expected = np.average(models, axis=0, weights=weights)
    found = average(levels, y, lambda eta: eta, 0.9, rng)
    assert list(found.p_active.values()) == pytest.approx(expected, abs=0.1)


def test_the_score_is_bic_and_prior() -> None:
    rng = np.random.default_rng(2)
    levels = pd.concat([corners('AB')] * 4, ignore_index=True)
    y = rng.normal(size=16)
    space = ModelSpace(levels, y)
    rest = y - y.mean() - levels['A'] * (levels['A'] @ y) / 16
    bic = 16 * np.log(rest @ rest / 16) + 2 * np.log(16)
    # A in and B out at 1/2 each; AB out with one parent active.
    prior = 2 * np.log(0.5) + np.log(0.9)
    assert space.score(np.array([True, False, False])) == pytest.approx(prior - bic / 2)


def test_an_alias_is_an_alternative_and_never_added() -> None:
    levels = repeated_levels(fraction('quarter'), 4)
    rng = np.random.default_rng(3)
    effect = levels['C'] * levels['E'] + levels[list('CEFG')].sum(axis=1)
    y = effect.to_numpy() + rng.normal(0, 0.5, len(levels))
    found = average(levels, y, lambda eta: eta, 0.9, rng)
    assert found.p_active['CE'] + found.p_active['FG'] == pytest.approx(1, abs=0.02)
    assert 0.3 < found.p_active['CE'] < 0.7  # all four parents are active: a toss of a coin


def test_heredity_decides_between_aliases() -> None:
    levels = repeated_levels(fraction('quarter'), 4)
    rng = np.random.default_rng(4)
    effect = levels['C'] * levels['E'] + levels[list('CE')].sum(axis=1)
    y = effect.to_numpy() + rng.normal(0, 0.5, len(levels))
    found = average(levels, y, lambda eta: eta, 0.9, rng)
    assert found.p_active['CE'] > 0.85
    assert found.choice in {f'{rest}' for rest in found.ranking if {'C', 'E'} <= set(rest)}


def test_sixteen_single_runs_are_enough_to_say_something() -> None:
    levels = repeated_levels(fraction('eighth'), 1)
    rng = np.random.default_rng(5)
    y = 300 + 50 * levels['C'].to_numpy() + rng.normal(0, 20, 16)
    found = average(levels, y, lambda eta: eta, 0.9, rng)
    assert found.p_active['C'] > 0.9
    assert all(np.isfinite(item.fit) for item in found.predictions.values())


def test_rows_that_cannot_tell_a_factor_from_the_constant() -> None:
    # The few runs that succeeded may all have the same sensor.
    levels = pd.concat([corners('ABC').query('A == 1')] * 3, ignore_index=True)
    rng = np.random.default_rng(7)
    y = 3.0 * levels['B'].to_numpy() + rng.normal(size=12)
    found = average(levels, y, lambda eta: eta, 0.9, rng)
    assert found.p_active['A'] == 0
    assert found.p_active['B'] + found.p_active['AB'] > 0.9


def test_the_quick_error_sum_of_squares_is_that_of_the_fit() -> None:
    levels = repeated_levels(fraction('quarter'), 2)
    response = 3500 + np.random.default_rng(8).normal(0, 30, len(levels)) + 20 * levels['C']
    space = ModelSpace(levels, response.to_numpy())
    rng = np.random.default_rng(9)
    for _ in range(20):
        active = rng.random(len(space.terms)) < 0.15
        terms = ['1', *np.array(space.terms)[active]]
        quick = space._sse(np.flatnonzero(np.concatenate([[True], active])))
        if quick is None:  # two names of one effect
            with pytest.raises(AliasedTermsError):
                ols(levels, response.to_numpy(), terms)
        else:
            assert quick == pytest.approx(ols(levels, response.to_numpy(), terms).sse, rel=1e-9)
