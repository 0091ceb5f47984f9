# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from hexapod_doe.designs.design import fraction
from hexapod_doe.designs.plan_file import write_plan
from hexapod_doe.designs.plan_table import make_plan
from hexapod_doe.designs.plan_types import Confirmation
from hexapod_doe.errors import BagError, TableError
from hexapod_doe.tables.bag_table import bag_responses, plan_rule, read_bags

from hexapod_doe import analyze

WriteBag = Callable[..., Path]


@pytest.fixture
def campaign(tmp_path: Path, write_bag: WriteBag) -> Path:
    """A campaign's folder: the plan of a 2^(7-3), and one bag for each of its rows."""
    plan = make_plan(fraction('eighth'), confirmation=Confirmation(runs=7, level=0.9))
    folder = tmp_path / 'tour'
    write_plan(plan, folder / 'plan.csv')
    for row in plan.rows.to_dict('records'):
        metadata = {str(key): str(value) for key, value in row.items()}
        write_bag(f'tour/runs/{row["run_id"]}', samples=0, gain=row['case'], **metadata)
    return folder


def test_a_campaign_is_a_table(campaign: Path) -> None:
    (table,) = read_bags([campaign])
    assert (table.title, table.design, len(table.rows)) == ('tour', 'eighth', 16)
    assert table.factors == tuple('ABCDEFG')
    assert table.factor_names['C'] == 'body orientation'
    rows = table.rows.set_index('case')
    assert rows.loc[16, 'label'] == 'ABCDEFG'
    assert rows.loc[1, 'label'] == '(none)'
    # The bags of these tests hold episode e's average return as 5·e·gain, up to episode 2.
    assert (rows['response'] == 10.0 * rows.index).all()


def test_learning_curves(campaign: Path) -> None:
    (table,) = read_bags([campaign])
    curve = table.curves[table.curves['case'] == 3]
    assert curve['episode'].tolist() == [0, 1, 2]
    assert curve['return'].tolist() == [0.0, 30.0, 60.0]


def test_a_run_is_judged_by_what_the_user_names(campaign: Path) -> None:
    (table,) = read_bags([campaign], response='mean_return')
    assert table.response == 'mean_return'
    # Episode e returns 10·e·gain: a run of episodes 0 to 2 has the mean 10·gain.
    assert (table.values == 10.0 * table.rows['case']).all()


def write_runs(write_bag: WriteBag, folder: str, name: str, evaluation: int) -> None:
    """Write bags of a run without A, and of one with it."""
    for gain, letters in enumerate(('', 'A'), start=1):
        described = {'run_id': f'{name}{letters}', 'observations': letters}
        path = f'{folder}/{name}{letters}'
        write_bag(path, samples=0, gain=gain, evaluation=evaluation, **described)


def test_runs_are_judged_by_their_evaluation_where_each_has_one(
    tmp_path: Path, write_bag: WriteBag, capsys: pytest.CaptureFixture[str]
) -> None:
    write_runs(write_bag, 'judged', 'r', evaluation=2)
    (table,) = read_bags([tmp_path / 'judged'], ['A'])
    assert table.response == 'evaluation_return'
    assert sorted(table.values) == [5.0, 10.0]  # 5·1·gain, after start 1
    write_runs(write_bag, 'judged', 'plain', evaluation=0)
    line = [str(tmp_path / 'judged'), '--factors', 'A', '--out', str(tmp_path / 'report')]
    assert analyze.main(line) == 2
    assert '2 of 4 runs have no evaluation' in capsys.readouterr().err
    (table,) = read_bags([tmp_path / 'judged'], ['A'], 'final_average_reward')
    assert len(table.rows) == 4


def test_evaluations_of_other_lengths_are_not_mixed(tmp_path: Path, write_bag: WriteBag) -> None:
    write_runs(write_bag, 'bags', 'short', evaluation=2)
    write_runs(write_bag, 'bags', 'long', evaluation=3)
    with pytest.raises(TableError, match=r'evaluation .*--blocks evaluation'):
        read_bags([tmp_path / 'bags'], ['A'])
    (table,) = read_bags([tmp_path / 'bags'], ['A'], blocks='evaluation')
    assert set(table.rows['block']) == {'2', '3'}


def test_the_command_line_reads_a_campaign(
    campaign: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(analyze, 'write_report', lambda analysis, out: out / 'index.html')
    assert analyze.main([str(campaign), '--out', str(tmp_path / 'out')]) == 0
    analysis = json.loads((tmp_path / 'out' / 'analysis.json').read_text())
    assert analysis['design']['name'] == 'eighth'
    assert analysis['options']['confirmation']['runs'] == 7
    assert analysis['curves']['case03_rep01']['return'] == [0.0, 30.0, 60.0]
    assert [step['name'] for step in analysis['steps']] == ['initial', 'reduced']
    assert analysis['purchase']['cheapest'] in analysis['ranking']


def test_several_bags_are_a_table_too(campaign: Path) -> None:
    bags = sorted((campaign / 'runs').iterdir())
    (table,) = read_bags(bags)
    assert len(table.rows) == 16


def test_the_plan_fixes_the_rule_of_confirmation(campaign: Path, tmp_path: Path) -> None:
    rule = plan_rule([campaign])
    assert (rule.runs, rule.level) == (7, 0.9)
    assert plan_rule([tmp_path]) == Confirmation()


@pytest.mark.parametrize(('replicates', 'column'), [(1, ''), (2, 'seed')])
def test_the_plan_says_that_seeds_are_blocks(
    tmp_path: Path, write_bag: WriteBag, replicates: int, column: str
) -> None:
    plan = make_plan(fraction('eighth'), replicates, common_seeds=True)
    write_plan(plan, tmp_path / 'tour' / 'plan.csv')
    for row in plan.rows.to_dict('records'):
        metadata = {str(key): str(value) for key, value in row.items()}
        write_bag(f'tour/runs/{row["run_id"]}', gain=row['case'], samples=0, **metadata)
    (table,) = read_bags([tmp_path / 'tour'])
    assert table.block_column == column
    assert ('block' in table.rows) == bool(column)
    (plain,) = read_bags([tmp_path / 'tour'], blocks='')
    assert plain.block_column == ''
    with pytest.raises(BagError, match="run case01_rep01: its metadata lacks the key 'machine'"):
        read_bags([tmp_path / 'tour'], blocks='machine')


@pytest.mark.parametrize(('options', 'blocks'), [([], 2), (['--article', '--trim-worst', '1'], 0)])
def test_the_article_knows_no_blocks(
    tmp_path: Path,
    write_bag: WriteBag,
    monkeypatch: pytest.MonkeyPatch,
    options: list[str],
    blocks: int,
) -> None:
    monkeypatch.setattr(analyze, 'write_report', lambda analysis, out: out / 'index.html')
    plan = make_plan(fraction('half', 3), 2, common_seeds=True)
    write_plan(plan, tmp_path / 'tour' / 'plan.csv')
    for number, row in enumerate(plan.rows.to_dict('records')):
        metadata = {str(key): str(value) for key, value in row.items()}
        write_bag(f'tour/runs/{row["run_id"]}', gain=1 + number, samples=0, **metadata)
    source = [str(tmp_path / 'tour'), '--factors', 'A,B,C', '--terms', 'A,B']
    assert analyze.main([*source, *options, '--out', str(tmp_path / 'out')]) == 0
    analysis = json.loads((tmp_path / 'out' / 'analysis.json').read_text())
    assert analysis['design']['blocks'] == blocks


def test_unfinished_runs_are_left_out(campaign: Path, write_bag: WriteBag) -> None:
    write_bag('tour/runs/late', samples=0, run_id='late', status='recording')
    (table,) = read_bags([campaign])
    assert len(table.rows) == 16
    assert table.caveats[0] == '1 bags of unfinished runs are left out.'


def test_no_complete_run(tmp_path: Path) -> None:
    (tmp_path / 'empty').mkdir()
    with pytest.raises(TableError, match='0 bags, none of a complete run'):
        read_bags([tmp_path / 'empty'])


def test_responses_of_confirmation_runs(tmp_path: Path, write_bag: WriteBag) -> None:
    for number, letters in enumerate(('ABCDE', 'ABCDE', '')):
        write_bag(f'confirm/{number}', episodes=2 + number, samples=0, observations=letters)
    assert bag_responses(tmp_path / 'confirm', 'final_average_reward') == {
        'ABCDE': [5.0, 10.0],
        '(none)': [15.0],
    }
    assert bag_responses(tmp_path / 'confirm', 'mean_return')['(none)'] == [15.0]
