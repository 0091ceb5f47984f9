# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import numpy as np
import pandas as pd
import pytest
from hexapod_doe.designs.design import fraction
from hexapod_doe.fitting.model import (
    AliasedTermsError,
    alias_strings,
    centre_points,
    check_rank,
    corners,
    estimable_terms,
    explain_dependent,
    independent_terms,
    labels,
    model_matrix,
    parents,
    parse_terms,
)


def levels_of(name: str) -> pd.DataFrame:
    design = fraction(name)
    return pd.DataFrame(design.levels, columns=list(design.factors))


def test_parse_terms_adds_the_constant_and_sorts() -> None:
    assert parse_terms('AB, A,B*A,B', 'AB') == ('1', 'A', 'B', 'AB')


def test_curvature_is_a_term_that_no_product_of_factors_is_called_by() -> None:
    assert parse_terms('A,curvature', 'AB') == ('1', 'A', 'curvature')
    assert parse_terms('CP,curvature', 'CP') == ('1', 'CP', 'curvature')
    levels = pd.DataFrame({'C': [-1, 1, 0], 'P': [1, 1, 0]})
    assert model_matrix(levels, ['CP', 'curvature']).tolist() == [[-1, 0], [1, 0], [0, 1]]


def test_switches_stay_on_or_off_at_centre_points() -> None:
    # As in cases/80_center_partial: A and B are numbers, C and D switches.
    levels = pd.DataFrame([[-1, 1, 1, -1], [0, 0, 1, -1]], columns=list('ABCD'))
    assert centre_points(levels).tolist() == [False, True]
    assert labels(levels) == ['BC', 'centre C']


@pytest.mark.parametrize(
    ('text', 'message'),
    [('A,AX', "unknown factor 'X'"), ('AA', 'different factor letters'), (' ,', 'no term named')],
)
def test_parse_terms_names_the_fault(text: str, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        parse_terms(text, 'AB')


def test_corners_are_in_yates_order() -> None:
    assert labels(corners('ABC')) == ['(none)', 'A', 'B', 'AB', 'C', 'AC', 'BC', 'ABC']


def test_parents() -> None:
    assert parents('ABD') == ('BD', 'AD', 'AB')
    assert parents('A') == parents('1') == parents('curvature') == ()


def test_aliased_terms_are_refused_by_name() -> None:
    with pytest.raises(AliasedTermsError, match=r'FG with CE.*3 terms have rank 2'):
        check_rank(levels_of('quarter'), ['1', 'CE', 'FG'])


def test_a_column_may_depend_on_several_others() -> None:
    # Without the case (+, +) of a 2^2 the product column is -1 - A - B: a plane through the
    # three points that are left.
    levels = pd.DataFrame({'A': [-1, 1, -1], 'B': [-1, -1, 1]})
    terms = ('1', 'A', 'B', 'AB')
    assert independent_terms(levels, terms) == ('1', 'A', 'B')
    assert explain_dependent(levels, terms) == {'AB': ('1', 'A', 'B')}


@pytest.mark.parametrize(('name', 'count'), [('quarter', 32), ('eighth', 16), ('full', 128)])
def test_saturated_model_has_a_term_for_each_case(name: str, count: int) -> None:
    levels = levels_of(name)
    terms = estimable_terms(levels)
    assert len(terms) == len(levels) == count
    matrix = model_matrix(levels, terms)
    assert np.array_equal(matrix.T @ matrix, count * np.eye(count))


def test_alias_strings_show_aliases_of_the_same_order() -> None:
    strings = alias_strings(levels_of('quarter'), ['1', 'A', 'CE', 'FG', 'ACE'])
    assert strings == {'1': '1', 'A': 'A', 'CE': 'CE + FG', 'FG': 'FG + CE', 'ACE': 'ACE + AFG'}
