# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Alias structures equal the reference tables and follow from word products."""

import json
from pathlib import Path

import numpy as np
import pytest
from hexapod_doe.designs.aliases import (
    alias_sets,
    alias_text,
    clear_interactions,
    defining_relation,
    defining_words,
    estimable,
    rank,
    representatives,
    resolution,
    word_length_pattern,
)
from hexapod_doe.designs.design import factor_letters, fraction, from_generators
from hexapod_doe.designs.terms import CONSTANT, product, terms_up_to
from hypothesis import given, settings
from hypothesis import strategies as st

DATA = Path(__file__).parents[2] / 'data' / 'doe_cases'
NAMES = {'quarter': 'alias_2_7_2', 'eighth': 'alias_2_7_3'}


@pytest.fixture(params=list(NAMES))
def published(request):
    """The design of the article and its reference alias structure."""
    reference = json.loads((DATA / f'{NAMES[request.param]}.json').read_text())
    return fraction(request.param), reference


def test_words_resolution_and_pattern_equal_the_reference(published):
    design, reference = published
    words = defining_words(design.levels, design.factors)
    assert words == design.words
    assert defining_relation(words) == reference['defining_relation']
    assert resolution(words) == reference['resolution']
    assert word_length_pattern(words, design.factors) == reference['word_length_pattern']


def test_alias_tables_equal_the_reference(published):
    design, reference = published
    second = alias_sets(design.levels, design.factors, 2)
    third = alias_sets(design.levels, design.factors, 3)
    assert [list(group.terms) for group in second] == reference['alias_table_up_to_2fi']
    assert [group.text for group in second] == reference['alias_text_up_to_2fi']
    assert [list(group.terms) for group in third] == reference['alias_table_up_to_3fi']


def test_representatives_equal_minitabs_saturated_model(published):
    design, reference = published
    terms = representatives(design.levels, design.factors, max_order=3)
    assert terms == reference['saturated_model_terms_minitab_order3']
    assert estimable(design.levels, design.factors, terms) == terms
    assert 1 + len(terms) == design.cases
    assert clear_interactions(design.levels, design.factors) == reference['clear_2fi']


def test_the_two_campaigns_together_still_confound_three_pairs():
    # alias_2_7_2.json, union_with_alias_2_7_3: CEFG is a word of both designs.
    reference = json.loads((DATA / 'alias_2_7_2.json').read_text())['union_with_alias_2_7_3']
    union = np.unique(np.vstack([fraction(name).levels for name in NAMES]), axis=0)
    terms = [CONSTANT, *terms_up_to('ABCDEFG', 2)]
    assert len(union) == reference['distinct_runs_union']
    assert len(terms) == reference['parameters']
    assert rank(union, 'ABCDEFG', terms) == reference['rank_main_plus_2fi_of_union']


@pytest.mark.parametrize('case', ['injection_2_6_2', 'leafspring_2_5_1_r3'])
def test_other_fractions_equal_their_reference(case):
    reference = json.loads((DATA / f'{case}.json').read_text())['design']
    text = {'injection_2_6_2': 'E=ABC,F=BCD', 'leafspring_2_5_1_r3': 'D=ABC'}[case]
    design = from_generators(text, {'injection_2_6_2': 6, 'leafspring_2_5_1_r3': 5}[case])
    found = alias_sets(design.levels, design.factors, 2)
    assert list(design.words) == reference['words']
    assert [list(group.terms) for group in found] == reference['aliases_up_to_2fi']


def test_alias_text_names_the_term_asked_for_first():
    design = fraction('quarter')
    assert alias_text('FG', design.levels, design.factors) == 'FG + CE'
    assert alias_text('C', design.levels, design.factors) == 'C'
    assert alias_text('C', design.levels, design.factors, max_order=3) == 'C + EFG'
    assert alias_text('ABD', design.levels, design.factors) == 'ABD + CF + EG'


def test_alias_text_carries_the_sign_of_the_fraction():
    design = from_generators('D=-ABC', 4)
    assert alias_text('AB', design.levels, design.factors) == 'AB - CD'
    assert defining_relation(design.words) == 'I = -ABCD'


def test_a_term_confounded_with_the_constant_has_no_alias_text():
    design = fraction('quarter')
    with pytest.raises(ValueError, match="'CEFG': confounded with the constant"):
        alias_text('CEFG', design.levels, design.factors)


@st.composite
def fractions(draw):
    """Draw fractions of six factors with two random generators."""
    words = st.sets(st.sampled_from('ABCD'), min_size=1).map(lambda s: ''.join(sorted(s)))
    first, second = draw(words), draw(words)
    return from_generators(f'E={first},F=-{second}', 6)


@settings(max_examples=40)
@given(fractions())
def test_aliases_are_the_products_of_a_term_with_the_defining_words(design):
    for group in alias_sets(design.levels, design.factors, 6):
        products = {product(group.representative, word) for word in design.words}
        assert set(group.terms) == {group.representative, *products}
        for term, sign in zip(group.terms, group.signs, strict=True):
            word = product(group.representative, term)
            assert sign == (1 if word == CONSTANT else design.words[word])


@settings(max_examples=40)
@given(st.integers(2, 6), st.data())
def test_any_subset_of_runs_is_spanned_by_its_estimable_terms(count, data):
    letters = factor_letters(count)
    full = fraction('full', count).levels
    rows = data.draw(st.sets(st.integers(0, len(full) - 1), min_size=1))
    levels = full[sorted(rows)]
    everything = terms_up_to(letters, count)
    kept = estimable(levels, letters, everything)
    assert 1 + len(kept) == len(levels) == rank(levels, letters, [CONSTANT, *kept])
