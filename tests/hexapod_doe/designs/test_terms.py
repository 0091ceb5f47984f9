# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Words over factors behave as a group, and their columns as its characters."""

import numpy as np
import pytest
from hexapod_doe.designs.augment import corners
from hexapod_doe.designs.terms import (
    CONSTANT,
    LETTERS,
    column,
    contains,
    letters_on,
    model_matrix,
    normalise,
    product,
    terms_up_to,
)
from hypothesis import given
from hypothesis import strategies as st

words = st.sets(st.sampled_from('ABCDEFG')).map(lambda s: ''.join(sorted(s)) or CONSTANT)


@given(words, words, words)
def test_products_form_an_abelian_group_in_which_each_word_is_its_own_inverse(a, b, c):
    assert product(a, b) == product(b, a)
    assert product(product(a, b), c) == product(a, product(b, c))
    assert product(a, CONSTANT) == a
    assert product(a, a) == CONSTANT


@given(words, words)
def test_the_column_of_a_product_is_the_product_of_columns(a, b):
    levels = corners(len('ABCDEFG'))
    both = column(levels, 'ABCDEFG', a) * column(levels, 'ABCDEFG', b)
    assert np.array_equal(column(levels, 'ABCDEFG', product(a, b)), both)


def test_terms_come_by_order_then_alphabet():
    assert terms_up_to('ABC', 3) == ['A', 'B', 'C', 'AB', 'AC', 'BC', 'ABC']
    assert terms_up_to('CBA', 2) == terms_up_to('ABC', 2)


def test_containment_is_proper():
    assert contains('ABD', 'AD')
    assert contains('A', CONSTANT)
    assert not contains('AB', 'AB')
    assert not contains('AB', 'C')


def test_columns_keep_leading_dimensions():
    levels = np.ones((4, 5, 3))
    assert column(levels, 'ABC', 'AC').shape == (4, 5)
    assert model_matrix(levels, 'ABC', [CONSTANT, 'A']).shape == (4, 5, 2)


def test_the_letters_on_are_the_observation_set():
    assert letters_on([1, -1, 1], 'ABC') == 'AC'
    assert letters_on([-1, -1, -1], 'ABC') == ''


@pytest.mark.parametrize(
    ('term', 'message'),
    [('AX', "unknown factor 'X'"), ('AA', 'different factor letters'), ('', 'different factor')],
)
def test_a_malformed_term_is_named(term, message):
    with pytest.raises(ValueError, match=message):
        normalise(term, 'ABCDEFG')


def test_the_alphabet_leaves_out_the_identity():
    assert 'I' not in LETTERS
    assert len(LETTERS) == 15
