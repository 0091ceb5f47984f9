# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import pytest
from hexapod_doe.designs.aliases import aberration_note
from hexapod_doe.designs.catalogue import catalogue_generators, fractions_of
from hexapod_doe.designs.design import Design, factor_letters, from_generators


def catalogued(count: int, generated: int) -> Design:
    letters = factor_letters(count)
    return Design('', letters, catalogue_generators(letters, generated))


def test_what_has_more_short_words_than_need_be_is_said():
    note = aberration_note(catalogued(12, 5))
    # Its words have the lengths 4, 10 times 5, 11 times 6; a better one has 8 of length 5.
    assert note.endswith('has 8 words of length 5 instead of 10.')
    generators = note.split('--generators ')[1].split()[0]
    assert aberration_note(from_generators(generators, 12)) == ''


@pytest.mark.parametrize(
    ('count', 'generated'),
    [(k, p) for k in range(3, 13) for p in fractions_of(k) if (k, p) != (12, 5)],
)
def test_the_others_are_not_blamed(count, generated):
    assert aberration_note(catalogued(count, generated)) == ''
