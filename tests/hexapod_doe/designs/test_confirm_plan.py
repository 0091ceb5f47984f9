# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Confirmation runs are planned by the rule, with the seeds that were stated before."""

import pytest
from hexapod_doe.designs.confirm_plan import confirmation_plan
from hexapod_doe.designs.design import fraction
from hexapod_doe.designs.plan_file import read_plan, write_plan
from hexapod_doe.designs.plan_table import make_plan
from hexapod_doe.designs.plan_types import Confirmation


@pytest.fixture
def plan():
    return make_plan(fraction('eighth'), 2, confirmation=Confirmation(runs=3, level=0.9))


def test_each_set_is_run_with_the_seeds_that_the_plan_kept(plan, tmp_path):
    further = confirmation_plan(plan, ['DC', '(none)'])
    write_plan(further, tmp_path / 'plan.csv')
    read = read_plan(tmp_path / 'plan.csv')
    for letters in ('CD', ''):
        seeds = read.rows.loc[read.rows['observations'] == letters, 'seed']
        assert tuple(seeds) == plan.settings.confirmation.seeds
    assert read.settings == further.settings
    assert read.settings.confirms == ('CD', '(none)')
    assert read.settings.predecessor == plan.fingerprint
    assert read.settings.confirmation == plan.settings.confirmation


def test_more_runs_than_the_rule_asks_for_have_fresh_seeds(plan):
    seeds = confirmation_plan(plan, ['CD'], 6).rows['seed'].tolist()
    assert tuple(seeds[:3]) == plan.settings.confirmation.seeds
    assert len({*seeds, *plan.rows['seed']}) == 6 + 32
    assert confirmation_plan(plan, ['CD'], 6).rows['seed'].tolist() == seeds


@pytest.mark.parametrize(
    ('sets', 'runs', 'message'),
    [
        ([], None, 'no set to confirm'),
        (['CX'], None, "set 'CX': expected letters of ABCDEFG"),
        (['CC'], None, "set 'CC'"),
        (['CD'], 2, '2 runs of each set: expected at least the 3'),
    ],
)
def test_what_the_rule_does_not_allow_is_refused(plan, sets, runs, message):
    with pytest.raises(ValueError, match=message):
        confirmation_plan(plan, sets, runs)
