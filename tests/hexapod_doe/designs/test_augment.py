# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Folded and augmented designs separate what the reference tables say they separate."""

import json
from pathlib import Path

import numpy as np
import pytest
from hexapod_doe.designs.aliases import alias_sets, defining_words, estimable, rank, resolution
from hexapod_doe.designs.augment import (
    aimed_model,
    d_optimal,
    foldover,
    semifold,
    variance_ratios,
)
from hexapod_doe.designs.design import fraction, from_generators
from hexapod_doe.designs.terms import CONSTANT, corners, terms_up_to
from hypothesis import given, settings
from hypothesis import strategies as st

DATA = Path(__file__).parents[2] / 'data' / 'doe_cases'
LETTERS = 'ABCDEFG'
ORDER_2 = terms_up_to(LETTERS, 2)
MIXED = ('CE', 'CF', 'CG', 'EF', 'EG', 'FG')


@pytest.mark.parametrize(('name', 'case'), [('quarter', 'alias_2_7_2'), ('eighth', 'alias_2_7_3')])
def test_every_foldover_leaves_the_aliases_of_the_reference(name, case):
    design = fraction(name)
    for on, expected in json.loads((DATA / f'{case}.json').read_text())['fold_over'].items():
        both = np.vstack([design.levels, foldover(design.levels, LETTERS, on)])
        words = defining_words(both, LETTERS)
        left = [g.text for g in alias_sets(both, LETTERS, 2) if len(g.terms) > 1]
        assert list(words) == expected['words_left']
        assert resolution(words) == expected['resolution']
        assert len(np.unique(both, axis=0)) == expected['distinct_runs']
        assert rank(both, LETTERS, [CONSTANT, *ORDER_2]) == expected['rank_main_plus_2fi']
        assert sorted(left) == sorted(expected['aliases_2fi_left'])


@pytest.mark.parametrize(('name', 'case'), [('quarter', 'alias_2_7_2'), ('eighth', 'alias_2_7_3')])
def test_the_best_semifolds_are_those_of_the_reference(name, case):
    expected = json.loads((DATA / f'{case}.json').read_text())['semifold_best_rank_main_plus_2fi']
    design = fraction(name)
    ranks = {}
    for on in LETTERS:
        for keep in (letter + sign for letter in LETTERS for sign in '+-'):
            added = semifold(design.levels, LETTERS, on, keep)
            assert len(added) == expected['runs_added']
            both = np.vstack([design.levels, added])
            text = f'fold {on}, runs with {keep[0]}={keep[1]}1'
            ranks[text] = rank(both, LETTERS, [CONSTANT, *ORDER_2])
    best = [text for text, value in ranks.items() if value == expected['rank']]
    assert max(ranks.values()) == expected['rank']
    assert len(best) == expected['n_options']
    assert best[: len(expected['options'])] == expected['options']


@given(st.sets(st.sampled_from(LETTERS), min_size=1), st.sampled_from(['quarter', 'eighth']))
def test_folding_twice_is_no_fold_and_keeps_the_words_it_flips_evenly(on, name):
    design = fraction(name)
    letters = ''.join(sorted(on))
    folded = foldover(design.levels, LETTERS, letters)
    assert np.array_equal(foldover(folded, LETTERS, letters), design.levels)
    both = np.vstack([design.levels, folded])
    # A word's column changes sign with the fold when it holds an odd number of folded letters.
    even = {word: s for word, s in design.words.items() if len(on & set(word)) % 2 == 0}
    assert defining_words(both, LETTERS) == even


@pytest.mark.parametrize(('extra', 'ratio'), [(8, 1.25), (4, 3.25)])
def test_few_cases_separate_every_term_of_the_quarter(extra, ratio):
    # 8 cases with CEFG = -1, balanced in all else: CE + FG has variance 1/32, CE - FG has 1/8,
    # so var(CE) = (1/32 + 1/8) / 4 = 1.25 / 32. With four cases the differences also carry the
    # error of terms that four rows cannot balance: 3.25, as computed elsewhere.
    design = fraction('quarter')
    added = d_optimal(design.levels, LETTERS, extra)
    both = np.vstack([design.levels, added])
    ratios = variance_ratios(both, LETTERS, ORDER_2, design.cases)
    assert len(ORDER_2) + 1 == 29 == rank(both, LETTERS, [CONSTANT, *ORDER_2])
    assert [ratios[term] for term in MIXED] == pytest.approx([ratio] * 6)
    assert max(ratios[term] for term in ORDER_2) == pytest.approx(ratio)


def test_three_cases_are_the_fewest_that_separate_the_quarter():
    design = fraction('quarter')
    both = np.vstack([design.levels, d_optimal(design.levels, LETTERS, 3)])
    ratios = variance_ratios(both, LETTERS, ORDER_2, design.cases)
    assert all(7.25 <= ratios[term] <= 8 + 1e-9 for term in MIXED)
    short = np.vstack([design.levels, d_optimal(design.levels, LETTERS, 2)])
    assert len(estimable(short, LETTERS, ORDER_2)) == 27
    with pytest.raises(ValueError, match=r'not enough to estimate FG beside'):
        variance_ratios(short, LETTERS, ORDER_2, design.cases)


@pytest.mark.parametrize('on', list('CEFG'))
def test_a_semifold_gives_the_variances_of_the_reference(on):
    design = fraction('quarter')
    for keep in (letter + sign for letter in LETTERS for sign in '+-'):
        both = np.vstack([design.levels, semifold(design.levels, LETTERS, on, keep)])
        ratios = variance_ratios(both, LETTERS, ORDER_2, design.cases)
        assert all(0.75 - 1e-9 <= ratios[term] <= 1 + 1e-9 for term in MIXED)


def test_augmentation_can_aim_at_one_pair():
    design = fraction('quarter')
    model = aimed_model(design.levels, LETTERS, ['FG'])
    assert set(model) == {*(t for t in ORDER_2 if t not in {'EF', 'EG'})}
    both = np.vstack([design.levels, d_optimal(design.levels, LETTERS, 1, model)])
    assert {'CE', 'FG'} <= set(estimable(both, LETTERS, model))


@settings(max_examples=10, deadline=None)
@given(st.integers(1, 4), st.integers(0, 100))
def test_d_optimal_cases_never_hurt_and_repeat_with_the_seed(extra, seed):
    design = from_generators('D=ABC', 4)
    first = d_optimal(design.levels, 'ABCD', extra, seed=seed, starts=3)
    again = d_optimal(design.levels, 'ABCD', extra, seed=seed, starts=3)
    assert np.array_equal(first, again)
    both = np.vstack([design.levels, first])
    # Three pairs are confounded, AB+CD, AC+BD, AD+BC; every added case frees one of them.
    assert rank(both, 'ABCD', [CONSTANT, *terms_up_to('ABCD', 2)]) == min(11, 8 + extra)


def test_corners_are_the_full_factorial_in_standard_order():
    assert np.array_equal(corners(4), fraction('full', 4).levels)


@pytest.mark.parametrize(
    ('call', 'message'),
    [
        (lambda d: foldover(d, LETTERS, 'X'), "unknown factor 'X'"),
        (lambda d: foldover(d, LETTERS, '1'), 'at least one factor'),
        (lambda d: semifold(d, LETTERS, 'C', 'A'), "keeps 'A': expected a factor and a sign"),
        (lambda d: d_optimal(d, LETTERS, 0), '0 extra cases'),
    ],
)
def test_malformed_requests_are_named(call, message):
    with pytest.raises(ValueError, match=message):
        call(fraction('quarter').levels)
