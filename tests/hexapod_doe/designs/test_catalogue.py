# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The catalogue's fractions have the resolution and word lengths that are printed for them."""

import pytest
from hexapod_doe.designs.aliases import resolution, word_length_pattern
from hexapod_doe.designs.catalogue import catalogue_generators, fractions_of
from hexapod_doe.designs.design import Design, factor_letters

# Montgomery, Design and Analysis of Experiments, 8th ed., Table 8.14 (resolutions).
RESOLUTION = {
    (3, 1): 3, (4, 1): 4, (5, 1): 5, (5, 2): 3, (6, 1): 6, (6, 2): 4, (6, 3): 3, (7, 1): 7,
    (7, 2): 4, (7, 3): 4, (7, 4): 3, (8, 2): 5, (8, 3): 4, (8, 4): 4, (9, 2): 6, (9, 3): 4,
    (9, 4): 4, (9, 5): 3, (10, 3): 5, (10, 4): 4, (10, 5): 4, (10, 6): 3, (11, 4): 5,
    (11, 5): 4, (11, 6): 4, (11, 7): 3, (12, 5): 4, (12, 6): 4, (12, 7): 4, (12, 8): 3,
}  # fmt: skip

# Chen, Sun and Wu 1993, International Statistical Review 61, 131-145: minimum aberration
# designs 8-3.1, 9-4.1, 9-3.1, 10-4.1, 11-5.1 and 12-6.1, (A4, A5, A6, ...).
WORDS = {
    (8, 3): [3, 4, 0, 0, 0],
    (9, 3): [1, 4, 2, 0, 0, 0],
    (9, 4): [6, 8, 0, 0, 1, 0],
    (10, 4): [2, 8, 4, 0, 1, 0, 0],
    (11, 5): [4, 14, 8, 0, 3, 2, 0, 0],
    (12, 6): [6, 24, 16, 0, 9, 8, 0, 0, 0],
}


def _design(count, generated):
    letters = factor_letters(count)
    return Design('', letters, catalogue_generators(letters, generated))


@pytest.mark.parametrize(('count', 'generated'), RESOLUTION)
def test_the_resolution_is_the_printed_one(count, generated):
    assert resolution(_design(count, generated).words) == RESOLUTION[count, generated]


@pytest.mark.parametrize(('count', 'generated'), WORDS)
def test_the_word_lengths_are_those_of_minimum_aberration(count, generated):
    design = _design(count, generated)
    pattern = word_length_pattern(design.words, design.factors)
    assert [pattern[f'A{size}'] for size in range(4, count + 1)] == WORDS[count, generated]
    assert pattern['A3'] == 0


def test_every_known_fraction_is_listed():
    listed = {(k, p) for k in range(2, 13) for p in fractions_of(k) if p}
    assert listed - set(RESOLUTION) == {(k, 1) for k in range(8, 13)}
    assert set(RESOLUTION) <= listed
