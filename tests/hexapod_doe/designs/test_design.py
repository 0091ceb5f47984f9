# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Designs equal their published tables, and any generators give an orthogonal fraction."""

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hexapod_doe.designs.aliases import defining_words
from hexapod_doe.designs.design import Design, factor_letters, fraction, from_generators
from hexapod_doe.designs.terms import column
from hypothesis import given
from hypothesis import strategies as st

DATA = Path(__file__).parents[2] / 'data' / 'doe_cases'


@st.composite
def designs(draw, max_factors=9):
    """Draw regular fractions with random generators and signs."""
    count = draw(st.integers(3, max_factors))
    generated = draw(st.integers(0, count - 2))
    letters = factor_letters(count)
    base = letters[: count - generated]
    words = st.sets(st.sampled_from(base), min_size=1).map(lambda s: ''.join(sorted(s)))
    chosen = draw(st.lists(words, min_size=generated, max_size=generated, unique=True))
    signs = draw(st.lists(st.sampled_from(['', '-']), min_size=generated, max_size=generated))
    pairs = zip(letters[count - generated :], signs, chosen, strict=True)
    return Design('random', letters, {factor: sign + word for factor, sign, word in pairs})


@pytest.mark.parametrize(('name', 'case'), [('quarter', 'alias_2_7_2'), ('eighth', 'alias_2_7_3')])
def test_the_articles_designs_equal_their_run_tables(name, case):
    table = pd.read_csv(DATA / f'{case}_runs.csv')
    reference = json.loads((DATA / f'{case}.json').read_text())
    design = fraction(name)
    assert np.array_equal(design.levels, table[list('ABCDEFG')])
    assert list(design.words) == reference['words']
    assert dict(design.generators) == reference['generators']


def test_the_cases_that_the_article_names_are_where_it_says():
    # Case 32 is ABCDEFG and case 5 is CG; these nine beat case 32 in the article's Table 4.
    sets = fraction('quarter').observations()
    named = {6: 'ACF', 8: 'ABCG', 14: 'ACDG', 16: 'ABCDF', 21: 'CE', 22: 'ACEFG', 28: 'ABDEG'}
    named |= {30: 'ACDE', 31: 'BCDE', 32: 'ABCDEFG', 5: 'CG'}
    assert {case: sets[case - 1] for case in named} == named
    assert 'ABCDE' not in sets
    assert 'ABCDE' not in fraction('eighth').observations()


@given(designs())
def test_every_fraction_is_balanced_and_its_columns_are_orthogonal_or_equal(design):
    levels = design.levels
    assert levels.shape == (2 ** len(design.base), len(design.factors))
    assert set(np.unique(levels)) == {-1, 1}
    gram = levels.T @ levels
    assert np.all(np.isin(np.abs(gram), [0, design.cases]))
    assert np.array_equal(levels.sum(axis=0), np.zeros(len(design.factors)))


@given(designs(max_factors=7))
def test_the_defining_words_are_exactly_the_constant_columns(design):
    assert len(design.words) == 2 ** len(design.generators) - 1
    for word, sign in design.words.items():
        assert np.all(column(design.levels, design.factors, word) == sign)


@given(designs(max_factors=7))
def test_the_base_factors_run_in_yates_order(design):
    bits = [design.levels[:, design.factors.index(letter)] > 0 for letter in design.base]
    numbers = sum(bit * 2**place for place, bit in enumerate(bits))
    assert np.array_equal(numbers, np.arange(design.cases))


def test_the_other_fraction_is_what_the_principal_one_leaves_out():
    plus, minus = from_generators('D=ABC', 4), from_generators('D=-ABC', 4)
    both = np.unique(np.vstack([plus.levels, minus.levels]), axis=0)
    assert len(both) == 16


@pytest.mark.parametrize(
    ('text', 'message'),
    [
        ('F=ABX', "'X' is not a base factor"),
        ('F=ABF', "'F' is not a base factor"),
        ('Z=AB', "unknown factor 'Z'"),
        ('F', 'expected FACTOR=WORD'),
        ('F=AAB', 'different base factors'),
        ('F=AB,F=CD', 'has a generator already'),
    ],
)
def test_a_malformed_generator_is_named(text, message):
    with pytest.raises(ValueError, match=message):
        from_generators(text)


@pytest.mark.parametrize('count', [1, 16])
def test_a_factor_count_out_of_range_is_named(count):
    with pytest.raises(ValueError, match=f'{count} factors: expected 2 to 15'):
        fraction('full', count)


def test_unknown_fractions_and_letters_are_named():
    with pytest.raises(ValueError, match="design 'third': expected one of full, half"):
        fraction('third')
    with pytest.raises(ValueError, match="factors 'AAB'"):
        fraction('full', 'AAB')
    with pytest.raises(ValueError, match=r'2\^\(3-2\): no catalogue generators'):
        fraction('quarter', 3)


def test_factor_letters_are_free():
    design = fraction('half', 'XYZ')
    assert design.generators == {'Z': 'XY'}
    assert design.observations() == ['Z', 'X', 'Y', 'XYZ']


def test_joined_fractions_hold_each_case_once_and_the_words_of_both():
    # Of the quarter's words the eighth has CEFG alone, with the same sign.
    both = fraction('quarter+eighth')
    assert both.cases == len(np.unique(both.levels, axis=0)) == 40
    assert both.words == {'CEFG': 1} == defining_words(both.levels, both.factors)
    with pytest.raises(ValueError, match='expected each fraction once'):
        fraction('quarter+quarter')
    with pytest.raises(ValueError, match="design 'third': expected one of full"):
        fraction('quarter+third')
