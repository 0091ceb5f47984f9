# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Plans hold every run of a design once, in a seeded random order, with seeds of their own."""

import numpy as np
import pytest
from hexapod_doe.designs.augment import foldover
from hexapod_doe.designs.design import fraction
from hexapod_doe.designs.plan_table import follow_up, make_plan
from hexapod_doe.designs.plan_types import Confirmation
from hypothesis import given, settings
from hypothesis import strategies as st

COLUMNS = ['StdOrder', 'RunOrder', 'case', 'replicate', 'seed', 'run_id', 'observations']


def test_the_articles_campaign_has_its_320_runs():
    design = fraction('quarter')
    plan = make_plan(design, replicates=10)
    rows = plan.rows
    assert list(rows.columns) == [*COLUMNS, *'ABCDEFG']
    assert len(rows) == 320
    assert rows['StdOrder'].tolist() == list(range(1, 321))
    assert np.array_equal(rows[list('ABCDEFG')], np.tile(design.levels, (10, 1)))
    assert rows.loc[rows['case'] == 32, 'observations'].tolist() == ['ABCDEFG'] * 10
    assert rows['seed'].is_unique
    assert rows['run_id'].is_unique


@settings(max_examples=25, deadline=None)
@given(st.sampled_from(['half', 'quarter', 'eighth']), st.integers(1, 4), st.integers(0, 999))
def test_run_order_is_a_permutation_of_all_rows_that_the_seed_repeats(name, replicates, seed):
    design = fraction(name)
    plan, again = (make_plan(design, replicates, seed) for _ in range(2))
    order = plan.rows['RunOrder']
    assert sorted(order) == list(range(1, design.cases * replicates + 1))
    assert plan.rows.equals(again.rows)
    assert not order.equals(make_plan(design, replicates, seed + 1).rows['RunOrder'])


def test_replicates_are_not_run_case_by_case():
    rows = make_plan(fraction('eighth'), replicates=5).rows.sort_values('RunOrder')
    assert (rows['case'].diff() == 0).mean() < 0.2
    assert (rows['replicate'].diff() == 0).mean() < 0.5


def test_common_seeds_are_the_same_list_in_every_case():
    rows = make_plan(fraction('eighth'), replicates=3, common_seeds=True).rows
    lists = rows.groupby('case')['seed'].apply(list)
    assert all(seeds == lists.iloc[0] for seeds in lists)
    assert len(set(lists.iloc[0])) == 3


def test_blocks_run_one_after_the_other():
    rows = make_plan(fraction('quarter'), replicates=2, blocks=['ACE']).rows
    ordered = rows.sort_values('RunOrder')['block']
    assert rows['block'].value_counts().tolist() == [32, 32]
    assert (ordered.diff().fillna(0) != 0).sum() == 1


def test_the_confirmation_rule_has_seeds_that_the_plan_does_not_use():
    plan = make_plan(fraction('eighth'), 2, confirmation=Confirmation(runs=7, level=0.9))
    rule = plan.settings.confirmation
    assert len(set(rule.seeds)) == 7
    assert not set(rule.seeds) & set(plan.rows['seed'])
    assert 'mean response of 7 new runs' in rule.rule
    assert '90 % prediction interval' in rule.rule


def test_a_follow_up_numbers_on_and_shares_nothing():
    plan = make_plan(fraction('quarter'), 2)
    added = foldover(plan.levels, plan.factors, 'C')
    further = follow_up(plan, added, 'foldover on C', replicates=1, seed=1)
    assert further.rows['case'].tolist() == list(range(33, 65))
    assert further.rows['StdOrder'].tolist() == list(range(65, 97))
    assert sorted(further.rows['RunOrder']) == list(range(1, 33))
    assert not set(further.rows['run_id']) & set(plan.rows['run_id'])
    used = set(plan.rows['seed']) | set(plan.settings.confirmation.seeds)
    assert not set(further.rows['seed']) & used
    assert further.settings.defining_relation == 'I = ABDEG'
    assert further.settings.resolution == 5
    assert further.settings.confirmation == plan.settings.confirmation


def test_a_follow_up_of_common_seeds_goes_on_with_them():
    plan = make_plan(fraction('quarter'), 2, common_seeds=True)
    added = foldover(plan.levels, plan.factors, 'C')
    further = follow_up(plan, added, 'foldover on C', replicates=3, seed=1)
    before = plan.rows.drop_duplicates('replicate')['seed'].tolist()
    seeds = further.rows.drop_duplicates('replicate')['seed'].tolist()
    assert seeds[:2] == before
    assert seeds[2] not in (*before, *plan.settings.confirmation.seeds)


def test_a_fold_of_a_blocked_plan_has_blocks_of_its_own():
    plan = make_plan(fraction('quarter'), blocks=['ACE'])
    added = foldover(plan.levels, plan.factors, 'C')
    further = follow_up(plan, added, 'foldover on C', replicates=1, seed=1)
    assert further.settings.blocks == ('ACE',)
    assert further.rows['block'].value_counts().to_dict() == {3: 16, 4: 16}
    both = further.rows.groupby('block').apply(
        lambda rows: (rows['A'] * rows['C'] * rows['E']).unique()
    )
    assert all(len(signs) == 1 for signs in both)


def test_a_fold_of_a_plan_without_blocks_is_one_block():
    plan = make_plan(fraction('half', 3))
    assert 'block' not in plan.rows
    added = foldover(plan.levels, plan.factors, 'C')
    further = follow_up(plan, added, 'foldover on C', replicates=1, seed=1)
    assert further.rows['block'].unique().tolist() == [2]
    assert further.settings.predecessor == plan.fingerprint
    again = follow_up(further, added, 'foldover on C', replicates=1, seed=1)
    assert again.rows['block'].unique().tolist() == [3]


@pytest.mark.parametrize(
    ('call', 'message'),
    [
        (lambda: make_plan(fraction('eighth'), 0), '0 replicates: expected at least 1'),
        (lambda: Confirmation(runs=0), '0 confirmation runs'),
        (lambda: Confirmation(level=1.0), 'level 1.0: expected between 0 and 1'),
        (lambda: make_plan(fraction('eighth'), blocks=['ABCE']), 'blocks ABCE'),
    ],
)
def test_plans_that_make_no_sense_are_refused(call, message):
    with pytest.raises(ValueError, match=message):
        call()
