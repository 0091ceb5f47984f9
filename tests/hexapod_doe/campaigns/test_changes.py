# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What a command changes of a plan's base reaches every row, and what the plan decides stays."""

from collections.abc import Callable
from pathlib import Path

import pytest
from hexapod_agent.learning import numerics
from hexapod_agent.specification.run_spec import ConfigError, RunSpec
from hexapod_doe.bags.run_identity import plan_differences, run_identity, spec_key
from hexapod_doe.campaigns.campaign import Campaign
from hexapod_doe.campaigns.changes import Changes
from hexapod_doe.campaigns.plan_copy import CONFIG_FILE, keep_config
from hexapod_doe.campaigns.row import Row, read_rows

from hexapod_doe import plan, run_case, run_fleet

FACTORS = """
- {name: body orientation, key: observations.C, low: off, high: on}
- {name: closeness, key: task.closeness_weight, low: 0, high: 2}
"""


@pytest.fixture
def made(tmp_path) -> Path:
    """Write a plan of two factors, four rows, on a base of its own."""
    (tmp_path / 'mine.yaml').write_text(FACTORS)
    out = tmp_path / 'c' / 'plan.csv'
    line = ['--factors', str(tmp_path / 'mine.yaml'), '--design', 'full', '--out', str(out)]
    plan.main([*line, '--set', 'learner.ddpg.n_step=3'])
    return out


@pytest.mark.parametrize('precision', ['bfloat16', 'float32_fast'])
def test_the_rows_of_a_campaign_have_one_precision(made, precision, monkeypatch):
    """A bag of another host's is another run, and no row mixes in without a word."""
    monkeypatch.setattr(numerics, 'computes_bfloat16', lambda: precision == 'bfloat16')
    rows = read_rows(made, Changes.of(None, ['training.precision=auto'], None))
    assert {row.spec.training.precision for row in rows} == {precision}
    assert {row.expected[spec_key('training.precision')] for row in rows} == {precision}


@pytest.mark.parametrize('levels', [('ddpg', 'sac'), ('ppo', 'ddpg')])
def test_the_precision_is_one_that_every_algorithm_of_a_plan_has(levels, tmp_path, monkeypatch):
    monkeypatch.setattr(numerics, 'computes_bfloat16', lambda: True)
    low, high = levels
    (tmp_path / 'f.yaml').write_text(
        f'- {{name: algorithm, key: learner.algorithm, low: {low}, high: {high}}}\n'
        '- {name: contacts, key: observations.G, low: off, high: on}\n'
    )
    out = tmp_path / 'c' / 'plan.csv'
    plan.main(['--factors', str(tmp_path / 'f.yaml'), '--design', 'full', '--out', str(out)])
    rows = read_rows(out, Changes.of(None, ['training.precision=auto'], None))
    assert {row.spec.training.precision for row in rows} == {'float32_fast'}
    with pytest.raises(ConfigError, match=r"is 'bfloat16', which learner.algorithm .* does not"):
        read_rows(out, Changes.of(None, ['training.precision=bfloat16'], None))


def test_bfloat16_is_refused_before_a_fleet_begins(made, monkeypatch, capsys):
    monkeypatch.setattr(numerics, 'computes_bfloat16', lambda: False)
    assert run_fleet.main(['--plan', str(made), '--set', 'training.precision=bfloat16']) == 2
    assert "training.precision is 'bfloat16', for which this" in capsys.readouterr().err
    assert not (made.parent / CONFIG_FILE).exists()


def test_a_row_is_the_changed_base_with_its_levels(made):
    changes = Changes.of(None, ['', 'task.line_y=0.2'], 7)
    for row in read_rows(made, changes):
        assert row.spec.training.episodes == 7
        assert row.spec.task.line_y == 0.2
        assert row.spec.learner.ddpg.n_step == 3
        assert row.spec.letters == row.observations
    weights = [row.spec.task.closeness_weight for row in read_rows(made, changes)]
    assert sorted(weights) == [0.0, 0.0, 2.0, 2.0]


@pytest.mark.parametrize(
    ('setting', 'told'),
    [
        (
            'task.closeness_weight=1',
            "closeness_weight is 1.0 by --config or --set, but factor 'cl",
        ),
        ('observations.C=on', "observations.C is True by --config or --set, but factor 'body"),
        ('observations.A=on', 'observations.A is True by --config or --set, but the plan decides'),
        ('task.colour=1', "unknown key 'task.colour'"),
    ],
)
@pytest.mark.parametrize('command', ['run_fleet', 'run_case'])
def test_what_the_plan_decides_is_one_error(made, capsys, command, setting, told):
    row = ['--row', '1'] if command == 'run_case' else []
    commands = {'run_fleet': run_fleet.main, 'run_case': run_case.main}
    assert commands[command](['--plan', str(made), '--set', setting, *row]) == 2
    error = capsys.readouterr().err
    assert told in error
    assert error.count('\n') == 1
    assert not (made.parent / 'runs').exists()


def said(row: Row) -> dict[str, str]:
    """Return what the bag of a row says of its run."""
    return {
        'observations': row.spec.letters,
        'seed': str(row.seed),
        'episodes': str(row.spec.training.episodes),
        'evaluation': str(row.spec.training.evaluation),
        'spec': row.spec.to_text(),
    }


@pytest.fixture
def other() -> Callable[[Row, str], str]:
    """Return a function that tells how a changed run of a row differs from what its plan says."""

    def tell(row: Row, setting: str) -> str:
        found = said(row) | {'spec': row.spec.with_settings([setting]).to_text()}
        return plan_differences(run_identity(found), row.identity)

    return tell


def test_a_plan_knows_levels_and_seed_of_its_rows_and_no_more(made, other):
    row = read_rows(made)[0]
    assert run_identity(said(row)) == row.expected
    assert other(row, 'task.line_y=0.2') == ''
    assert 'config.task.closeness_weight 7.0, expected' in other(row, 'task.closeness_weight=7')
    assert row.varied == {'config.observations.C', 'config.task.closeness_weight'}
    assert 'config.task.line_y' in row.shared
    assert not row.varied & row.shared.keys()


def test_the_folder_keeps_a_base_that_is_not_the_plans(made):
    kept = made.parent / CONFIG_FILE
    keep_config(made, Campaign.open(made, changes=Changes.of(None, (), 7)).base)
    assert not kept.exists()  # each bag tells its length
    base = Campaign.open(made, changes=Changes.of(None, ['task.line_y=0.2'], 7)).base
    keep_config(made, base)
    assert RunSpec.load(kept) == base
    assert read_rows(made, Changes.of(kept, (), None))[0].treatments.base == base


def test_a_file_may_say_what_the_plan_says(made, tmp_path):
    config = tmp_path / 'all.yaml'
    config.write_text(read_rows(made)[0].treatments.base.to_text())
    assert read_rows(made, Changes.of(config, (), None)) == read_rows(made)
    config.write_text('observations: C')
    with pytest.raises(ConfigError, match=r'observations\.C is True'):
        read_rows(made, Changes.of(config, (), None))
