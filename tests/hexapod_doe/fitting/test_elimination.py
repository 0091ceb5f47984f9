# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import numpy as np
import pandas as pd
import pytest
from hexapod_doe.designs.design import fraction
from hexapod_doe.fitting.elimination import eliminate, with_parents
from hexapod_doe.fitting.model import corners, parents
from hexapod_doe.fitting.regression import ols


@pytest.fixture
def interaction_only() -> tuple[pd.DataFrame, np.ndarray]:
    """A 2^3 in four replicates whose only real effect is AB."""
    levels = pd.concat([corners('ABC')] * 4, ignore_index=True)
    noise = np.random.default_rng(7).normal(0, 1, len(levels))
    return levels, 10 + 8 * levels['A'].to_numpy() * levels['B'].to_numpy() + noise


TERMS = ('1', 'A', 'B', 'C', 'AB', 'AC', 'BC', 'ABC')


def test_hierarchy_keeps_the_parents(interaction_only: tuple[pd.DataFrame, np.ndarray]) -> None:
    kept, _ = eliminate(*interaction_only, TERMS)
    assert kept == ('1', 'A', 'B', 'AB')


def test_without_hierarchy_parents_go(interaction_only: tuple[pd.DataFrame, np.ndarray]) -> None:
    kept, _ = eliminate(*interaction_only, TERMS, hierarchy=False)
    assert kept == ('1', 'AB')


def test_protected_terms_stay(interaction_only: tuple[pd.DataFrame, np.ndarray]) -> None:
    kept, _ = eliminate(*interaction_only, TERMS, hierarchy=False, protected=('C',))
    assert kept == ('1', 'C', 'AB')


def test_the_trace_agrees_with_refits(interaction_only: tuple[pd.DataFrame, np.ndarray]) -> None:
    levels, y = interaction_only
    _, trace = eliminate(levels, y, TERMS)
    terms = list(TERMS)
    for item in trace:
        before = ols(levels, y, terms)
        assert item.p == pytest.approx(before.p[before.terms.index(item.term)], rel=1e-9)
        terms.remove(item.term)
        after = ols(levels, y, terms)
        assert (item.s, item.r2, item.r2_adj) == pytest.approx((after.s, after.r2, after.r2_adj))


def test_ties_go_to_the_higher_order_then_to_the_end_of_the_alphabet() -> None:
    levels = pd.concat([corners('AB')] * 2, ignore_index=True)
    error = np.repeat([1.0, -1.0], 4)  # orthogonal to every term: all p are 1
    _, trace = eliminate(levels, error, ('1', 'A', 'B', 'AB'), hierarchy=False)
    assert [item.term for item in trace] == ['AB', 'B', 'A']


def test_missing_parents_are_added() -> None:
    assert with_parents(corners('ABC'), ('1', 'ABC')) == (
        '1', 'A', 'B', 'C', 'AB', 'AC', 'BC', 'ABC',
    )  # fmt: skip


def test_a_parent_that_is_aliased_with_a_term_is_not_added() -> None:
    design = fraction('quarter')
    levels = pd.DataFrame(design.levels, columns=list(design.factors))
    assert with_parents(levels, ('1', 'C', 'E', 'F', 'G', 'CE', 'FG'[:1])).count('FG') == 0


@pytest.mark.parametrize('seed', range(5))
def test_what_is_left_keeps_its_parents(seed: int) -> None:
    rng = np.random.default_rng(seed)
    levels = pd.concat([corners('ABCD')] * 2, ignore_index=True)
    terms = with_parents(levels, ('1', 'ABCD'))
    y = rng.normal(0, 1, len(levels)) + rng.normal(0, 1, 3) @ np.array(
        [levels['A'] * levels['B'], levels['C'], levels['B'] * levels['C'] * levels['D']]
    )
    kept, _ = eliminate(levels, y, terms)
    assert all(parent in kept for term in kept for parent in parents(term))
