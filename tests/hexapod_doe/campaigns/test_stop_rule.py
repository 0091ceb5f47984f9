# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A campaign ends by its rule, for everybody who is at it, and goes on when somebody says so."""

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from hexapod_doe.analysis.stop_look import look_at
from hexapod_doe.campaigns.campaign import Campaign
from hexapod_doe.campaigns.folder import read_progress
from hexapod_doe.campaigns.next_steps import after_status
from hexapod_doe.campaigns.overview import summary
from hexapod_doe.campaigns.stop_rule import (
    STOP_FILE,
    Look,
    StopRule,
    go_on,
    read_stop,
    stopped_text,
)
from simulated import Truth
from simulated_study import finish, plan_campaign

from hexapod_doe import campaign_status, run_case, run_fleet


def asks(loss: float | None) -> Callable[[Path], Look]:
    return lambda directory: Look(48, 'AC', loss, '' if loss is not None else 'too few')


@pytest.fixture(scope='module')
def trained(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An eighth with five replicates in turns, of which the first three are done."""
    folder = tmp_path_factory.mktemp('stop') / 'mine'
    plan = plan_campaign(folder, 'eighth', 5, in_turns=True)
    finish(plan, Truth(failure={'1': -50.0}), seed=1, rows=48)
    return folder


@pytest.fixture
def campaign(trained: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(trained, tmp_path / 'mine'))


def test_a_round_is_as_many_runs_as_cases(campaign: Path) -> None:
    assert StopRule(campaign, 16, 5.0, asks(9.0)).due()
    assert not StopRule(campaign, 17, 5.0, asks(9.0)).due()  # two rounds are too few
    assert not StopRule(campaign, 16, 0.0, asks(9.0)).due()  # no rule


def test_each_round_is_looked_at_once(campaign: Path) -> None:
    rule = StopRule(campaign, 16, 5.0, asks(9.0))
    assert rule.look() == ''
    assert not rule.due()
    assert StopRule(campaign, 16, 5.0, asks(1.0)).look() == ''  # another process, the same round
    record = read_stop(campaign)
    assert record is not None
    assert [look.expected_loss for look in record.looks] == [9.0]


def test_what_cannot_be_analysed_goes_on(campaign: Path) -> None:
    assert StopRule(campaign, 16, 5.0, asks(None)).look() == ''
    found = json.loads((campaign / STOP_FILE).read_text())
    assert found['looks'][0]['reason'] == 'too few'


def test_a_campaign_that_its_rule_ended_is_complete(
    campaign: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = StopRule(campaign, 16, 10.0, asks(9.0)).look()
    assert text == (
        'complete by its rule: after 48 runs AC is expected to lose 9, below stop_when 10'
    )
    opened = Campaign.open(campaign / 'plan.csv')
    assert opened.finished
    assert opened.take('w1') is None
    progress = read_progress(campaign)
    assert progress.complete
    assert progress.seconds_left == 0
    assert text in summary(progress)
    assert after_status(campaign, progress)[0].startswith('ros2 run hexapod_doe analyze')
    assert campaign_status.main([str(campaign)]) == 0
    assert 'complete by its rule' in ' '.join(capsys.readouterr().out.split())


def test_it_goes_on_when_somebody_says_so(campaign: Path) -> None:
    StopRule(campaign, 16, 10.0, asks(9.0)).look()
    go_on(campaign)
    assert stopped_text(campaign) == ''
    opened = Campaign.open(campaign / 'plan.csv')
    assert not opened.finished
    assert opened.take('w1') is not None
    record = read_stop(campaign)
    assert record is not None
    assert len(record.looks) == 1  # what was said stays on record


def test_the_rows_of_a_round_are_those_of_a_replicate(campaign: Path) -> None:
    rows = Campaign.open(campaign / 'plan.csv').rows
    assert [row.metadata['replicate'] for row in rows[:48]] == ['1'] * 16 + ['2'] * 16 + ['3'] * 16
    assert [row.metadata['case'] for row in rows[:16]] != [str(n) for n in range(1, 17)]


def test_the_analysis_is_asked(campaign: Path) -> None:
    look = look_at(campaign)
    assert look.done == 48
    assert look.expected_loss is not None
    assert look.expected_loss > 0
    shutil.rmtree(campaign / 'runs')
    (campaign / 'runs').mkdir()
    assert look_at(campaign).expected_loss is None


def test_a_fleet_begins_no_run_once_the_loss_is_small(
    campaign: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    plan = str(campaign / 'plan.csv')
    assert run_fleet.main(['--plan', plan, '--processes', '1', '--stop-when', '1e6']) == 0
    assert 'complete by its rule: after 48 runs' in capfd.readouterr().out
    assert run_fleet.main(['--plan', plan]) == 0  # not silently, and nothing is trained
    assert '--go-on trains the others' in capfd.readouterr().out
    last = Campaign.open(Path(plan)).rows[-1].metadata['StdOrder']
    assert run_case.main(['--plan', plan, '--row', last]) == 0
    assert 'is not needed: complete by its rule' in capfd.readouterr().out


def test_a_broken_record_is_named(campaign: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (campaign / STOP_FILE).write_text('{')
    assert run_fleet.main(['--plan', str(campaign / 'plan.csv')]) == 2
    assert 'stop.json: not the record of a stop rule' in capsys.readouterr().err
