# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The alias matrix against its definition, on regular, irregular and damaged designs."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hexapod_doe.analysis.analysis import analyse
from hexapod_doe.designs.design import fraction
from hexapod_doe.fitting.alias_matrix import (
    alias_matrix,
    partial_aliases,
    with_partial_aliases,
    without_arbitrary,
)
from hexapod_doe.fitting.model import corners, estimable_terms
from hexapod_doe.records.options import Options
from hexapod_doe.tables.csv_table import read_csv

CASES = Path(__file__).parents[2] / 'data' / 'cases'


def levels_of(name: str) -> pd.DataFrame:
    design = fraction(name)
    return pd.DataFrame(design.levels, columns=list(design.factors))


def plackett_burman() -> pd.DataFrame:
    rows = pd.read_csv(CASES / 's11_plackett_burman_12.csv')
    return rows[[name for name in rows.columns if name != 'y']]


def test_it_is_the_regression_of_the_omitted_columns_on_the_estimated_ones() -> None:
    levels = plackett_burman()
    matrix = alias_matrix(levels, ('1', *levels.columns))
    x = np.column_stack([np.ones(12), levels])
    bc = levels['B'] * levels['C']
    expected = np.linalg.inv(x.T @ x) @ x.T @ bc
    assert matrix.weights[:, matrix.omitted.index('BC')] == pytest.approx(expected)
    # Every main effect holds a third of each interaction of two others (Plackett, Burman 1946).
    for name in levels.columns:
        found = matrix.partial(name)
        assert len(found) == 45
        assert np.abs(list(found.values())) == pytest.approx(np.full(45, 1 / 3))


@pytest.mark.parametrize('name', ['half', 'quarter', 'eighth', 'full'])
def test_a_regular_fraction_has_no_partial_aliases(name: str) -> None:
    levels = levels_of(name)
    terms = estimable_terms(levels)
    assert partial_aliases(levels, terms) == {}
    assert without_arbitrary(levels, terms) == terms


def test_a_lost_case_spreads_the_interaction_that_it_told() -> None:
    levels = levels_of('half').drop(columns=['F', 'G']).drop_duplicates()
    half = levels[levels.prod(axis=1) == 1].iloc[1:]  # a 2^(5-1) that lost one of 16 cases
    terms = estimable_terms(half, 2)
    assert len(terms) == 15
    found = partial_aliases(half, terms)
    assert all(set(others) == {'DE'} for others in found.values())
    assert without_arbitrary(half, terms) == terms


def test_what_only_the_alphabet_chose_is_left_out() -> None:
    levels = pd.read_csv(CASES / 'F6b_pb12_6factors.csv')[list('ABCDEF')]
    assert without_arbitrary(levels, estimable_terms(levels)) == ('1', *'ABCDEF')


@pytest.mark.parametrize('name', ['F6b_pb12_6factors', 's11_plackett_burman_12'])
def test_no_set_of_an_irregular_design_is_called_safe(name: str) -> None:
    analysis = analyse(read_csv(CASES / f'{name}.csv', 'y'), Options())
    assert analysis.attribution is not None
    assert analysis.attribution.safe == ()
    assert not any(p.alias_safe for p in analysis.predictions)
    assert analysis.design.aliases['A'].startswith('A - 0.33·BC - 0.33·BD')
    assert any('hold parts of interactions' in caveat for caveat in analysis.caveats)


def test_wrong_interactions_do_not_stand_for_the_real_one() -> None:
    # The truth is 100 + 5A + 4DE.
    analysis = analyse(read_csv(CASES / 'F6b_pb12_6factors.csv', 'y'), Options())
    assert all(len(term) == 1 for term in analysis.final.terms)
    assert any('does not fit all cases' in caveat for caveat in analysis.caveats)
    assert analysis.averaging is not None
    assert analysis.averaging.p_active['DE'] > 0.95
    chosen = corners('ABCDEF').set_index(pd.Index([p.label for p in analysis.predictions]))
    best = chosen.loc[analysis.averaging.choice]
    assert (best['A'], best['D'] * best['E']) == (1, 1)


def test_partial_aliases_are_named_with_their_weights() -> None:
    assert with_partial_aliases('A', {'BC': -1 / 3, 'DE': 0.5}) == 'A - 0.33·BC + 0.5·DE'
