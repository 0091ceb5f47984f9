# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

from concurrent.futures import ThreadPoolExecutor

import pytest
from hexapod_doe.campaigns.plan_copy import place_plan
from hexapod_doe.designs.plan_file import PlanError


@pytest.fixture
def plan(folder):
    """Return a plan with its settings beside it."""
    (folder.directory / 'plan.json').write_text('{}')
    return folder.directory / 'plan.csv'


def test_a_plan_stays_where_it_is(plan):
    assert place_plan(plan, None) == plan
    assert place_plan(plan, plan.parent) == plan


def test_rows_and_settings_are_copied_and_nothing_else_is_left(plan, tmp_path):
    out = tmp_path / 'some' / 'where'
    assert place_plan(plan, out) == out / 'plan.csv'
    assert (out / 'plan.csv').read_bytes() == plan.read_bytes()
    assert sorted(path.name for path in out.iterdir()) == ['plan.csv', 'plan.json']


def test_any_number_of_jobs_may_place_it_at_once(plan, tmp_path):
    with ThreadPoolExecutor(8) as jobs:
        placed = list(jobs.map(lambda _: place_plan(plan, tmp_path / 'out'), range(32)))
    assert set(placed) == {tmp_path / 'out' / 'plan.csv'}


def test_another_plan_is_not_replaced(plan, tmp_path):
    out = tmp_path / 'out'
    place_plan(plan, out)
    plan.write_text(plan.read_text().replace('r1', 'r9'))
    with pytest.raises(PlanError, match='another plan'):
        place_plan(plan, out)


def test_a_plan_of_other_factors_is_another(plan, tmp_path):
    place_plan(plan, tmp_path / 'out')
    plan.with_suffix('.json').write_text('{"factors": [{"letter": "A", "high": 2}]}')
    with pytest.raises(PlanError, match='another plan'):
        place_plan(plan, tmp_path / 'out')


def test_a_missing_plan_is_named(tmp_path):
    with pytest.raises(FileNotFoundError, match=r'none\.csv'):
        place_plan(tmp_path / 'none.csv', tmp_path / 'out')
