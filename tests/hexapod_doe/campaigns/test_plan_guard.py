# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A plan is never written over the runs of another one."""

import pytest
from hexapod_doe.campaign_status import main as campaign_status
from hexapod_doe.campaigns.campaign import Campaign
from hexapod_doe.campaigns.row import read_rows
from hexapod_doe.errors import CampaignError

from hexapod_doe import plan, run_case, run_fleet


@pytest.fixture
def make(tmp_path):
    """Return what plans two rows into a campaign's folder."""

    def make(*options: str) -> None:
        small = ['--generators', 'B=A', '--factors', '2']
        plan.main([*small, *options, '--out', str(tmp_path / 'plan.csv')])

    return make


@pytest.fixture
def bag(tmp_path, write_bag):
    """Return what writes the bag of the plan's n-th row, with changes."""

    def bag(number: int = 0, **changes: str) -> str:
        row = read_rows(tmp_path / 'plan.csv')[number]
        write_bag(f'runs/{row.run_id}', **dict(row.metadata) | changes)
        return row.run_id

    return bag


def test_a_plan_without_runs_is_made_anew(make, tmp_path):
    make('--seed', '1')
    before = read_rows(tmp_path / 'plan.csv')
    make('--seed', '2')
    assert before != read_rows(tmp_path / 'plan.csv')


@pytest.mark.parametrize('trace', ['', '.partial', '.cut_1', '.checkpoint.pt'])
def test_a_plan_with_runs_stays(make, tmp_path, capsys, trace):
    make('--seed', '1')
    run_id = read_rows(tmp_path / 'plan.csv')[0].run_id
    (tmp_path / 'runs').mkdir()
    (tmp_path / 'runs' / f'{run_id}{trace}').mkdir()
    text = (tmp_path / 'plan.csv').read_bytes()
    make('--seed', '1')  # the same once more
    with pytest.raises(SystemExit) as ended:
        make('--seed', '2')
    assert ended.value.code == 2
    assert (tmp_path / 'plan.csv').read_bytes() == text
    error = capsys.readouterr().err
    assert error.count('\n') == 1
    assert 'a plan with runs (1 run in' in error
    assert '--out' in error


def test_runs_whose_plan_is_gone_are_no_runs_of_another(make, bag, tmp_path, capsys):
    make('--seed', '1')
    bag()
    (tmp_path / 'plan.csv').unlink()
    with pytest.raises(SystemExit):
        make('--seed', '2')
    assert 'of another plan' in capsys.readouterr().err
    make('--seed', '1')


def test_the_bag_of_another_run_is_named_and_no_row_is_done_by_it(make, bag, tmp_path, capsys):
    make('--seed', '1')
    odd, own = bag(0, seed='5'), bag(1)
    campaign = Campaign.open(tmp_path / 'plan.csv')
    assert campaign.done == {own}
    with pytest.raises(CampaignError, match=rf'1 of 2 rows.*{odd} \(seed 5, expected \d+\)'):
        campaign.check_own()
    assert campaign_status([str(tmp_path)]) == 1
    shown = capsys.readouterr().out
    assert '1 done, 1 other' in shown
    assert f'{odd} has the bag of another run: seed 5, expected' in shown


def test_runs_of_another_length_are_not_passed_over(make, bag, tmp_path, capsys):
    make('--seed', '1')
    run_ids = {bag(0), bag(1)}
    options = ['--plan', str(tmp_path / 'plan.csv'), '--episodes']
    assert run_fleet.main([*options, '6']) == 2
    told = capsys.readouterr().err
    assert told.count('\n') == 1
    assert all(f'{run_id} (episodes 3, expected 6)' in told for run_id in run_ids)
    assert run_fleet.main([*options, '3']) == 0
    assert run_case.main([*options, '6', '--row', '1']) == 2
    assert 'episodes 3, expected 6' in capsys.readouterr().err
    assert run_case.main([*options, '3', '--row', '1']) == 0


def test_runs_of_another_configuration_are_not_passed_over(make, bag, tmp_path, capsys):
    make('--seed', '1')
    bag(config='actor: {hidden: [8, 8]}')
    options = ['--plan', str(tmp_path / 'plan.csv'), '--episodes', '3']
    assert run_fleet.main(options) == 2
    assert 'config.learner.actor.hidden [8, 8], expected' in capsys.readouterr().err
    assert campaign_status([str(tmp_path)]) == 1  # it does not know the configuration
    assert '1 done' in capsys.readouterr().out


def test_runs_that_are_not_alike_are_told_by_the_status(make, bag, tmp_path, capsys):
    make('--seed', '1')
    bag(0, config='actor: {hidden: [8, 8]}')
    bag(1, config='actor: {hidden: [9, 9]}')
    campaign_status([str(tmp_path)])
    assert 'not alike: config.learner.actor.hidden' in capsys.readouterr().out
