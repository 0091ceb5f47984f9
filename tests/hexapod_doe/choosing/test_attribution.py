# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import numpy as np
import pandas as pd
import pytest
from hexapod_doe.choosing.attribution import alias_safe, attribute, candidates
from hexapod_doe.designs.design import fraction
from hexapod_doe.fitting.model import corners, estimable_terms, labels, model_matrix

GRID = corners('ABCDEFG')
RNG = np.random.default_rng(1)


def levels_of(name: str) -> pd.DataFrame:
    design = fraction(name)
    return pd.DataFrame(design.levels, columns=list(design.factors))


def test_the_ambiguous_terms_of_the_quarter() -> None:
    found = candidates(levels_of('quarter'), ('1', 'C', 'CE', 'CF', 'AB'))
    assert found == {'CE': (('CE', 1), ('FG', 1)), 'CF': (('CF', 1), ('EG', 1))}


def test_half_of_the_quarters_predictions_are_safe() -> None:
    # CE = FG wherever C·E·F·G = +1, whichever of the three pairs is in the model.
    safe = alias_safe(levels_of('quarter'), ('1', 'CE', 'CF', 'CG'))
    word = GRID[list('CEFG')].prod(axis=1).to_numpy() == 1
    assert (safe == word).all()


def test_only_the_runs_of_the_eighth_are_safe() -> None:
    levels = levels_of('eighth')
    safe = alias_safe(levels, estimable_terms(levels, 2))
    assert set(np.array(labels(GRID))[safe]) == set(labels(levels))


def test_every_naming_of_the_eighth() -> None:
    levels = levels_of('eighth')
    terms = estimable_terms(levels, 2)
    coef = np.random.default_rng(2).normal(size=len(terms))
    found = attribute(levels, terms, coef, lambda eta: eta, RNG)
    assert found.attributions == found.examined == 3**7
    assert sum(found.winners.values()) == 3**7
    assert found.rank_range['(none)'][0] <= found.rank_range['(none)'][1]


def test_one_ambiguous_term_by_hand() -> None:
    # 10·CE or 10·FG: the sets with C = E are worth 10 under the first name, those with F = G
    # under the second one.
    found = attribute(
        levels_of('quarter'), ('1', 'CE'), np.array([0.0, 10.0]), lambda eta: eta, RNG
    )
    assert found.attributions == 2
    assert found.fit_range['CE'] == (10, 10)
    assert found.fit_range['CEF'] == (-10, 10)
    assert len(found.safe) == 64


def test_every_run_is_fitted_alike_under_every_name() -> None:
    levels = levels_of('quarter')
    group = candidates(levels, ('CE',))['CE']
    columns = model_matrix(levels, [term for term, _ in group]) * [sign for _, sign in group]
    assert (columns[:, 0] == columns[:, 1]).all()


def test_a_negative_generator_gives_a_negative_sign() -> None:
    levels = levels_of('quarter').assign(F=lambda rows: -rows['F'])
    assert candidates(levels, ('CE',)) == {'CE': (('CE', 1), ('FG', -1))}


def test_a_full_factorial_is_safe() -> None:
    found = attribute(GRID, ('1', 'A', 'AB'), np.array([1.0, 2.0, 3.0]), lambda eta: eta, RNG)
    assert found.ambiguous == {}
    assert found.winners == {'AB': 1}
    assert len(found.safe) == 128


def test_the_winners_add_up(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr('hexapod_doe.choosing.attribution.MAX_EXAMINED', 100)
    levels = levels_of('eighth')
    terms = estimable_terms(levels, 2)
    coef = np.random.default_rng(3).normal(size=len(terms))
    found = attribute(levels, terms, coef, lambda eta: eta, RNG)
    assert (found.attributions, found.examined) == (3**7, 100)
    assert sum(found.winners.values()) == 100
