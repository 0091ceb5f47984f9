# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""From the first plan to the judged confirmation by the lines that the tools print."""

import json
import re
import shlex
from dataclasses import replace
from pathlib import Path

import pytest
import understood
import yaml
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_doe.campaign_status import main as campaign_status
from hexapod_doe.campaigns.folder import read_progress
from hexapod_doe.campaigns.next_steps import after_confirmation, after_status
from hexapod_doe.campaigns.progress import State
from hexapod_doe.campaigns.row import read_rows
from hexapod_doe.reporting import text

from hexapod_doe import analyze, plan


@pytest.fixture
def campaign(tmp_path: Path) -> Path:
    out = str(tmp_path / 'mine' / 'plan.csv')
    half = ['--design', 'half', '--factors', '3', '--replicates', '3', '--confirm-runs', '2']
    plan.main([*half, '--out', out])
    return tmp_path / 'mine'


@pytest.fixture
def train(write_bag):
    """Return what fills the rows of a plan: C is worth 20, and runs differ a little."""

    def train(folder: Path, **changes: object) -> None:
        for number, row in enumerate(read_rows(folder / 'plan.csv')):
            gain = 5 + 2 * ('C' in row.observations) + 0.1 * (number % 3)
            given = dict(row.metadata) | changes
            write_bag(str(row.bag), gain=gain, **given)

    return train


def lines(text: str) -> list[str]:
    """Return the lines that a tool says to type next."""
    found = re.search(r'^next:\n((?:  .*\n)+)', text, re.MULTILINE | re.IGNORECASE)
    return [line.strip() for line in found[1].splitlines()] if found else []


def status(folder: Path, capsys) -> list[str]:
    campaign_status([str(folder)])
    return lines(capsys.readouterr().out)


def test_the_lines_lead_from_the_plan_to_the_judged_confirmation(
    campaign, train, tmp_path, capsys, monkeypatch
):
    monkeypatch.setattr(analyze, 'write_report', lambda analysis, out: out / 'index.html')
    monkeypatch.setattr(text, 'TOUR_EPISODES', 3)
    launch = 'ros2 launch hexapod_bringup campaign.launch.xml plan:='
    assert status(campaign, capsys) == [f'{launch}{campaign}/plan.csv']
    train(campaign)
    (line,) = status(campaign, capsys)
    assert line == f'ros2 run hexapod_doe analyze {campaign} --out {campaign}/report'

    options = [str(campaign), '--factors', 'A,B,C', '--out', str(tmp_path / 'out')]
    assert analyze.main(options) == 0
    confirm, run, again = lines(capsys.readouterr().out)
    assert run == f'{launch}{campaign}/confirm/plan.csv episodes:=3'
    assert shlex.split(again) == ['ros2', 'run', 'hexapod_doe', 'analyze', *options]
    words = shlex.split(confirm)
    assert words[:5] == ['ros2', 'run', 'hexapod_doe', 'plan', 'confirm']

    plan.main(words[4:])
    assert lines(capsys.readouterr().out)[0] == run
    assert status(campaign, capsys) == [run]
    train(campaign / 'confirm')
    (line,) = status(campaign / 'confirm', capsys)
    assert line == f'ros2 run hexapod_doe analyze {campaign} --out {campaign}/report'

    assert analyze.main(options) == 0
    learn, judge = lines(capsys.readouterr().out)
    assert learn.startswith('ros2 run hexapod_agent train --seed 1 --episodes 3 --observations ')
    assert judge.startswith('ros2 run hexapod_agent evaluate runs/')
    for line in (learn, judge):
        understood.check(shlex.split(line))
    record = json.loads((tmp_path / 'out' / 'analysis.json').read_text())
    checks = {check['label']: check for check in record['confirmation']['checks']}
    assert all(len(check['observed']) == 2 for check in checks.values())
    assert checks['C']['passed']
    assert record['design']['runs'] == 12  # those that confirm are not fitted


def test_a_tour_leads_to_a_campaign_that_is_long_enough(
    campaign, train, tmp_path, capsys, monkeypatch
):
    monkeypatch.setattr(analyze, 'write_report', lambda analysis, out: out / 'index.html')
    train(campaign)
    assert analyze.main([str(campaign), '--factors', 'A,B,C', '--out', str(tmp_path / 'o')]) == 0
    (line,) = lines(capsys.readouterr().out)
    assert 'plan hours --hours 8' in line
    plan.main(shlex.split(line)[4:])
    assert 'Proposed:' in capsys.readouterr().out


def test_the_agent_of_a_confirmed_case_has_the_values_of_its_runs(tmp_path):
    entries = [
        {'name': 'E', 'key': 'observations.E', 'low': False, 'high': True},
        {'name': 'payload', 'key': 'robot.payload', 'low': 0.0, 'high': 1.2},
        {'name': 'hidden', 'key': 'learner.actor.hidden', 'low': [16, 8], 'high': [32]},
    ]
    file, out = tmp_path / 'factors.yaml', tmp_path / 'mine' / 'plan.csv'
    file.write_text(yaml.safe_dump(entries))
    plan.main(['--factors', str(file), '--design', 'full', '--set', 'training.episodes=7',
               '--out', str(out)])  # fmt: skip
    (tmp_path / 'mine' / 'config.yaml').write_text('task: {line_y: 0.1}')
    learn, judge = after_confirmation(out.parent, [1, 1, -1])
    words = shlex.split(learn)
    understood.check(words)
    settings = [words[index + 1] for index, word in enumerate(words) if word == '--set']
    spec = RunSpec.load(None, settings)
    assert words[words.index('--observations') + 1] == 'E'
    assert words[words.index('--episodes') + 1] == '7'
    assert (spec.robot.payload, spec.learner.actor.hidden) == (1.2, (16, 8))
    assert spec.task.line_y == 0.1
    understood.check(shlex.split(judge))


def test_a_campaign_that_runs_is_watched(campaign):
    progress = read_progress(campaign)
    runs = {name: replace(run, state=State.RUNNING) for name, run in progress.runs.items()}
    (line,) = after_status(campaign, replace(progress, runs=runs))
    assert line == f'ros2 run hexapod_bringup watch {campaign}'
    understood.check(shlex.split(line))


def test_sets_are_those_that_the_analysis_puts_first(campaign, train, capsys):
    train(campaign)
    plan.main(['confirm', str(campaign), '--replicates', '4'])
    assert re.match('12 runs: .*C', capsys.readouterr().out)


def test_a_campaign_without_runs_has_nothing_to_confirm(campaign, capsys):
    with pytest.raises(SystemExit):
        plan.main(['confirm', str(campaign)])
    assert 'none of a complete run' in capsys.readouterr().err
    plan.main(['confirm', str(campaign), '--sets', 'C,none'])
    assert len(read_rows(campaign / 'confirm' / 'plan.csv')) == 4


def test_confirmation_runs_of_another_length_are_refused(campaign, train, tmp_path, capsys):
    train(campaign)
    plan.main(['confirm', str(campaign), '--sets', 'C'])
    train(campaign / 'confirm', episodes=4)
    assert analyze.main([str(campaign), '--factors', 'A,B,C', '--out', str(tmp_path / 'o')]) == 2
    assert 'confirm: episodes 4, expected 3' in capsys.readouterr().err


def test_the_configuration_that_the_folder_keeps_is_named(campaign, train, capsys):
    (campaign / 'config.yaml').write_text('actor: {hidden: [8]}')
    train(campaign)
    plan.main(['confirm', str(campaign), '--sets', 'C'])
    assert lines(capsys.readouterr().out)[0].endswith(f'config:={campaign}/config.yaml')
