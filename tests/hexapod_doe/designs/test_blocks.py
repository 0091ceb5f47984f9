# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Blocks split a design evenly and hide exactly the words that define them."""

import numpy as np
import pytest
from hexapod_doe.designs.blocks import block_labels, confounded_with_blocks
from hexapod_doe.designs.design import fraction


def test_one_word_gives_two_even_blocks_and_hides_itself():
    full = fraction('full', 4)
    labels = block_labels(full.levels, full.factors, ['ABCD'])
    assert np.bincount(labels).tolist() == [0, 8, 8]
    assert confounded_with_blocks(full.levels, full.factors, ['ABCD'], 4) == ['ABCD']


def test_two_words_hide_their_product_too():
    # Montgomery, section 7.6: a 2^4 in four blocks by ABD and BCD also gives up AC.
    full = fraction('full', 4)
    assert sorted(set(block_labels(full.levels, 'ABCD', ['ABD', 'BCD']))) == [1, 2, 3, 4]
    assert confounded_with_blocks(full.levels, 'ABCD', ['ABD', 'BCD']) == ['AC', 'ABD', 'BCD']


def test_in_a_fraction_the_aliases_are_hidden_as_well():
    quarter = fraction('quarter')
    assert confounded_with_blocks(quarter.levels, quarter.factors, ['ACE']) == ['ACE + AFG']


def test_without_words_there_is_one_block():
    quarter = fraction('quarter')
    assert set(block_labels(quarter.levels, quarter.factors, [])) == {1}


@pytest.mark.parametrize('words', [['CEFG'], ['AB', 'AB']])
def test_words_that_do_not_split_the_cases_are_refused(words):
    quarter = fraction('quarter')
    with pytest.raises(ValueError, match='expected independent words'):
        block_labels(quarter.levels, quarter.factors, words)
