# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import numpy as np
import pytest
from hexapod_doe.analysis.analysis import analyse
from hexapod_doe.analysis.describe import summarise
from hexapod_doe.designs.design import fraction
from hexapod_doe.records.options import Options
from simulated import repeated_levels, table_of


def caveats(design: str, response: np.ndarray, **options: object) -> str:
    levels = repeated_levels(fraction(design), 4)
    return '\n'.join(analyse([table_of(levels, response)], Options(**options)).caveats)


def noise(runs: int, seed: int = 1) -> np.ndarray:
    return np.random.default_rng(seed).normal(0, 10, runs)


def test_a_confounded_pair_is_named_with_what_depends_on_it() -> None:
    levels = repeated_levels(fraction('quarter'), 4)
    effect = 30 * (levels['C'] + levels['C'] * levels['E'])
    text = caveats('quarter', 500 + effect.to_numpy() + noise(128), alpha=1e-6)
    assert 'which effect is real: CE or FG. 64 of 128 predictions depend on the name' in text


def test_many_winners_are_counted() -> None:
    text = caveats('eighth', noise(64), max_order=2, eliminate=False)
    assert ' more.' in text
    assert '112 of 128 predictions depend on the name' in text


def test_lack_of_fit_is_said() -> None:
    levels = repeated_levels(fraction('quarter'), 4)
    effect = 40 * levels['A'] * levels['C'] * levels['E']
    text = caveats('quarter', 500 + effect.to_numpy() + noise(128), max_order=2)
    assert 'does not fit all cases (lack of fit p = ' in text


def test_a_needless_transform_is_said() -> None:
    levels = repeated_levels(fraction('quarter'), 4)
    text = caveats('quarter', 500 + 100 * levels['A'].to_numpy() + noise(128), transform='boxcox')
    assert 'needs no transform' in text


@pytest.mark.parametrize(
    ('name', 'relation', 'resolution', 'size'),
    [
        ('full', 'I', None, '2^7'),
        ('quarter', 'I = CEFG = ABCDF = ABDEG', 4, '2^(7-2)'),
        ('eighth', 'I = ABCE = ABFG = ACDG = ADEF = BCDF = BDEG = CEFG', 4, '2^(7-3)'),
    ],
)
def test_the_design_is_read_off_the_rows(
    name: str, relation: str, resolution: int | None, size: str
) -> None:
    levels = repeated_levels(fraction(name), 1)
    found = summarise(table_of(levels, noise(len(levels))), {})
    assert (found.defining_relation, found.resolution, found.name) == (relation, resolution, size)
    assert found.cases == found.expected_cases == len(levels)
