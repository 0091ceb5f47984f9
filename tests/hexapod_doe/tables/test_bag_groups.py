# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Which runs are one table: a plan's, those of what follows it, and none that are not alike."""

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from hexapod_doe.campaigns.row import read_rows
from hexapod_doe.errors import TableError
from hexapod_doe.tables.bag_table import read_bags

from hexapod_doe import plan

FACTORS = 'ABC'
Fill = Callable[..., Path]


@pytest.fixture
def fill(tmp_path: Path, write_bag: Callable[..., Path]) -> Fill:
    """Return what fills the rows of a plan, each with its own return, and returns the folder."""

    def fill(name: str, file: str = 'plan.csv', **changes: str) -> Path:
        for row in read_rows(tmp_path / name / file):
            gain = int(row.metadata['StdOrder'])
            write_bag(f'{name}/runs/{row.run_id}', gain=gain, **dict(row.metadata) | changes)
        return tmp_path / name

    return fill


@pytest.fixture
def base(tmp_path: Path, fill: Fill) -> Path:
    """A half fraction of three sensors with two replicates, all of it run."""
    out = str(tmp_path / 'base' / 'plan.csv')
    plan.main(['--design', 'half', '--factors', '3', '--replicates', '2', '--out', out])
    return fill('base')


def fold(base: Path, out: Path, on: str = 'C') -> None:
    plan.main(['fold', str(base / 'plan.csv'), '--on', on, '--out', str(out)])


@pytest.mark.parametrize('first', ['base', 'fold'])
def test_a_fold_and_its_base_are_one_table_in_either_order(base, fill, tmp_path, first):
    fold(base, tmp_path / 'fold' / 'plan.csv')
    folders = sorted([base, fill('fold')], key=lambda folder: folder.name != first)
    (table,) = read_bags(folders, FACTORS)
    assert (table.title, table.design) == ('base', 'half + foldover on C')
    assert len(table.rows) == 16
    assert table.rows['case'].nunique() == 8
    assert sorted(table.rows['run_order']) == list(range(1, 17))
    # What was run later is a block of its own.
    assert table.block_column == 'block'
    assert table.rows['block'].value_counts().to_dict() == {'1.1': 8, '2.2': 8}


def test_a_fold_in_the_folder_of_its_base_is_the_same_table(base, fill):
    fold(base, base / 'more.csv')
    (table,) = read_bags([fill('base', 'more.csv')], FACTORS)
    assert len(table.rows) == 16
    assert table.rows['block'].nunique() == 2


def test_what_adds_to_what_adds_joins_too(base, fill, tmp_path):
    fold(base, tmp_path / 'fold' / 'plan.csv')
    fill('fold')
    fold(tmp_path / 'fold', tmp_path / 'again' / 'plan.csv', 'B')
    (table,) = read_bags([fill('again'), tmp_path / 'fold', base], FACTORS)
    assert len(table.rows) == 24
    assert table.rows['block'].nunique() == 3


def test_two_plans_that_add_to_one_are_told_apart(base, fill, tmp_path):
    fold(base, tmp_path / 'c' / 'plan.csv', 'C')
    fold(base, tmp_path / 'b' / 'plan.csv', 'B')
    (table,) = read_bags([base, fill('c'), fill('b')], FACTORS)
    assert len(table.rows) == 24
    assert table.rows['run_id'].is_unique
    assert table.rows['case'].nunique() == 8  # both folds are the other half


def test_an_older_follow_up_joins_by_its_numbers(base, fill, tmp_path):
    fold(base, tmp_path / 'fold' / 'plan.csv')
    path = tmp_path / 'fold' / 'plan.json'
    path.write_text(''.join(line for line in path.open() if '"base"' not in line))
    (table,) = read_bags([fill('fold'), base], FACTORS)
    assert len(table.rows) == 16


def test_a_fold_without_its_base_says_so(base, fill, tmp_path):
    fold(base, tmp_path / 'fold' / 'plan.csv')
    (table,) = read_bags([fill('fold')], FACTORS)
    assert len(table.rows) == 8
    assert 'adds to another plan (half + foldover on C)' in table.caveats[0]


def test_two_possible_bases_are_refused(base, fill, tmp_path, write_bag):
    fold(base, tmp_path / 'fold' / 'plan.csv')
    (tmp_path / 'copy').mkdir()
    for name in ('plan.csv', 'plan.json'):
        (tmp_path / 'copy' / name).write_bytes((base / name).read_bytes())
    with pytest.raises(TableError, match=r'may follow that of any of .*base, .*copy'):
        read_bags([base, fill('copy'), fill('fold')], FACTORS)


def test_linked_runs_are_read_with_their_plan(base, tmp_path):
    # The runs folder is a link, and one run in it is a link again.
    elsewhere = tmp_path / 'disk' / 'all'
    elsewhere.parent.mkdir()
    (base / 'runs').rename(elsewhere)
    (base / 'runs').symlink_to(elsewhere)
    run = next(elsewhere.iterdir())
    run.rename(tmp_path / 'disk' / 'one')
    run.symlink_to(tmp_path / 'disk' / 'one')
    (elsewhere / 'loop').symlink_to(base)
    (table,) = read_bags([base], FACTORS)
    assert (table.title, table.design, len(table.rows)) == ('base', 'half', 8)


@pytest.mark.parametrize(
    ('changes', 'told'),
    [
        ({'episodes': 5}, 'episodes 5 in odd_rep01; 3 in the other 8'),
        ({'config': 'actor: {hidden: [8]}'}, r'config.learner.actor.hidden \[8\] in odd_rep01'),
    ],
)
def test_runs_that_are_not_alike_are_named_and_refused(base, fill, write_bag, changes, told):
    for bag in (base / 'runs').iterdir():
        for file in bag.iterdir():
            file.unlink()
        bag.rmdir()
    fill('base', config='')
    row = dict(read_rows(base / 'plan.csv')[0].metadata)
    write_bag('base/runs/odd', **row | {'run_id': 'odd_rep01', 'config': ''} | changes)
    with pytest.raises(TableError, match=f'not alike.*{told}.*--blocks'):
        read_bags([base], FACTORS)


def test_a_difference_that_is_a_block_is_analysed(base, fill, tmp_path):
    fold(base, tmp_path / 'fold' / 'plan.csv')
    folders = [base, fill('fold', episodes=4)]
    with pytest.raises(TableError, match='episodes 4 in'):
        read_bags(folders, FACTORS)
    (table,) = read_bags(folders, FACTORS, blocks='episodes')
    assert table.rows['block'].value_counts().to_dict() == {'3': 8, '4': 8}


def test_runs_of_two_bases_are_blocks_by_configuration(base, fill, tmp_path):
    fold(base, tmp_path / 'fold' / 'plan.csv')
    for bag in (base / 'runs').iterdir():
        shutil.rmtree(bag)
    folders = [fill('base', spec='{}'), fill('fold', spec='task: {line_y: 1}')]
    with pytest.raises(TableError, match=r'task.line_y 1.0 in .*--blocks config'):
        read_bags(folders, FACTORS)
    (table,) = read_bags(folders, FACTORS, blocks='config')
    assert sorted(table.rows['block'].value_counts()) == [8, 8]


def test_other_versions_are_told(base, fill, tmp_path):
    fold(base, tmp_path / 'fold' / 'plan.csv')
    changes = {'version.numpy': '2.4.6'}
    (table,) = read_bags([base, fill('fold', **changes)], FACTORS)
    assert not any('numpy' in caveat for caveat in table.caveats)  # the others do not say
    fold(base, tmp_path / 'late' / 'plan.csv', 'B')
    (table,) = read_bags(
        [tmp_path / 'fold', fill('late', **{'version.numpy': '1.26.4'}), base], FACTORS
    )
    told = [caveat for caveat in table.caveats if 'version.numpy 1.26.4 in' in caveat]
    assert len(told) == 1
    assert '2.4.6 in' in told[0]


def test_a_bag_that_is_not_its_rows_is_left_out_by_name(base, tmp_path):
    rows = read_rows(base / 'plan.csv')
    text = (base / 'plan.csv').read_text()
    (base / 'plan.csv').write_text(text.replace(str(rows[0].seed), '12345'))
    (table,) = read_bags([base], FACTORS)
    assert len(table.rows) == 7
    expected = f'{rows[0].run_id} (seed {rows[0].seed}, expected 12345)'
    assert any(expected in caveat for caveat in table.caveats)
