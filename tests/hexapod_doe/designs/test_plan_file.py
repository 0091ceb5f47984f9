# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Plans survive their files, and a spoilt file is refused with its row and value."""

import pytest
from hexapod_doe.designs.augment import foldover
from hexapod_doe.designs.design import fraction
from hexapod_doe.designs.plan_file import PlanError, read_plan, write_plan
from hexapod_doe.designs.plan_table import follow_up, make_plan


@pytest.fixture
def path(tmp_path):
    """A plan of the eighth fraction with two replicates, in a folder of its own."""
    file = tmp_path / 'new' / 'plan.csv'
    write_plan(make_plan(fraction('eighth'), 2, common_seeds=True), file)
    return file


@pytest.mark.parametrize('options', [{}, {'common_seeds': True}, {'blocks': ['ABD']}])
def test_a_plan_reads_back_as_written(tmp_path, options):
    plan = make_plan(fraction('eighth'), 2, seed=7, **options)
    write_plan(plan, tmp_path / 'plan.csv')
    read = read_plan(tmp_path / 'plan.csv')
    assert read.rows.equals(plan.rows)
    assert read.settings == plan.settings
    assert read.factors == 'ABCDEFG'


def test_the_empty_set_is_empty_text(path):
    first = read_plan(path).rows.iloc[0]
    assert (first['case'], first['observations']) == (1, '')


def test_a_table_without_settings_is_a_plan(path):
    path.with_suffix('.json').unlink()
    plan = read_plan(path)
    assert plan.settings is None
    assert follow_up(plan, foldover(plan.levels, 'ABCDEFG', 'C'), 'fold', 1, 1).rows.size


def _edit(path, row, column, value):
    lines = path.read_text().splitlines()
    cells = lines[row].split(',')
    cells[lines[0].split(',').index(column)] = value
    lines[row] = ','.join(cells)
    path.write_text('\n'.join(lines) + '\n')


@pytest.mark.parametrize(
    ('row', 'column', 'value', 'message'),
    [
        (3, 'C', '0', r'plan.csv row 3: level C is 0, expected -1 or 1'),
        (3, 'C', 'high', r"row 3: C is 'high', expected an integer"),
        (2, 'observations', 'AX', r"row 2: observations 'AX', expected 'AEG'"),
        (2, 'seed', '-5', r'row 2: seed -5, expected 0 to 2\^64 - 1'),
        (2, 'seed', '1.5', r"row 2: seed is '1.5', expected an integer"),
        (2, 'run_id', '../etc', r"run_id '../etc', expected a letter"),
        (2, 'run_id', 'case01_rep01', r'run_id case01_rep01 occurs twice'),
        (2, 'StdOrder', '1', r'StdOrder 1 occurs twice'),
        (2, 'case', '1', r'case 1, replicate 1 occurs twice'),
        (18, 'case', '40', r''),
        (2, 'RunOrder', '99', r'RunOrder is not a permutation of 1 to 32'),
        (0, 'seed', 'Seed', r"no column 'seed', expected StdOrder, RunOrder"),
    ],
)
def test_a_spoilt_table_is_refused_with_its_place(path, row, column, value, message):
    _edit(path, row, column, value)
    if not message:  # cases may have different numbers of replicates
        assert len(read_plan(path).levels) == 17
        return
    with pytest.raises(PlanError, match=message):
        read_plan(path)


def test_a_case_must_have_one_set(path):
    text = path.read_text().replace('_rep02,AEG,1,-1,-1,-1,1,-1,1', '_rep02,AE,1,-1,-1,-1,1,-1,-1')
    path.write_text(text)
    with pytest.raises(PlanError, match='one set per case'):
        read_plan(path)


@pytest.mark.parametrize(
    ('text', 'message'),
    [
        ('', 'empty file, expected a header'),
        ('StdOrder,RunOrder,case,replicate,seed,run_id,observations,A\n', 'no rows'),
        ('StdOrder,RunOrder,case,replicate,seed,run_id,observations\n1,1,1,1,1,a,\n', 'no factor'),
        ('a,b\n1,2\n1,2,3,4\n', 'line 3: 4 fields, expected 2'),
    ],
)
def test_files_that_hold_no_plan_are_refused(tmp_path, text, message):
    (tmp_path / 'plan.csv').write_text(text)
    with pytest.raises(PlanError, match=message):
        read_plan(tmp_path / 'plan.csv')


def test_spoilt_settings_are_refused(path):
    path.with_suffix('.json').write_text('{"design": "eighth"}')
    with pytest.raises(PlanError, match=r'plan.json: not the settings of a plan'):
        read_plan(path)


def test_a_missing_file_is_missing(tmp_path):
    with pytest.raises(FileNotFoundError):
        read_plan(tmp_path / 'plan.csv')
