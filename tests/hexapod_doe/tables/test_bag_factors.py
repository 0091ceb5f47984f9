# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Runs whose factors are keys of the specification: read from bags alone, reported by name."""

import dataclasses
import re
import shutil
from pathlib import Path

import pytest
from hexapod_doe.analysis.analysis import analyse
from hexapod_doe.campaigns.row import read_rows
from hexapod_doe.errors import BagError, TableError
from hexapod_doe.records.options import Options
from hexapod_doe.reporting.figures.chart import Chart
from hexapod_doe.reporting.report import render, sections
from hexapod_doe.reporting.tables import Table
from hexapod_doe.tables.bag_table import bag_responses, read_bags

from hexapod_doe import analyze, plan

FACTORS = """
- {name: body orientation, key: observations.C, low: off, high: on, device: IMU with fusion}
- {name: yaw share, key: task.yaw_share, low: 0, high: 1}
- {name: learning rate, key: learner.actor.learning_rate, low: 1.0e-4, high: 2.0e-4}
- {name: hidden units, key: learner.actor.hidden, low: [32, 32], high: [64, 64]}
"""


@pytest.fixture
def campaign(tmp_path: Path, write_bag) -> Path:
    """Half a factorial of four factors with a bag for each row; the second one (B) matters."""
    (tmp_path / 'factors.yaml').write_text(FACTORS)
    out = tmp_path / 'mixed' / 'plan.csv'
    options = ['--factors', str(tmp_path / 'factors.yaml'), '--design', 'half']
    plan.main([*options, '--replicates', '2', '--out', str(out)])
    for number, row in enumerate(read_rows(out)):
        described = dict(row.metadata) | {'spec': row.spec.to_text()}
        gain = 10.0 + 2.0 * (row.spec.task.yaw_share == 0.0) + 0.01 * (number * 7 % 11)
        write_bag(f'mixed/runs/{row.run_id}', samples=0, gain=gain, **described)
    return out.parent


def test_levels_come_from_the_bags_alone(campaign: Path, tmp_path: Path) -> None:
    (planned,) = read_bags([campaign])
    shutil.copytree(campaign / 'runs', tmp_path / 'elsewhere')
    (alone,) = read_bags([tmp_path / 'elsewhere'])
    assert planned.factors == alone.factors == ('C', 'A', 'B', 'D')
    assert planned.factor_names['A'] == 'yaw share'
    assert planned.named == alone.named
    labels = {
        row.run_id: row.label.replace('none', '(none)') for row in read_rows(campaign / 'plan.csv')
    }
    assert dict(zip(alone.rows['run_id'], alone.rows['label'], strict=True)) == labels
    columns = ['run_id', *alone.factors, 'response']
    ordered = [t.rows[columns].sort_values('run_id', ignore_index=True) for t in (planned, alone)]
    assert ordered[0].equals(ordered[1])


def test_the_report_names_factors_and_levels(campaign: Path) -> None:
    analysis = analyse(read_bags([campaign]), Options())
    printed = analyze.summary(analysis)
    assert re.search(r'choice: .*body orientation o(n|ff).*yaw share 0', printed)
    assert 'yaw share: part of the task' in printed
    drawn = sections(analysis)
    charts = [i for section in drawn for i in section.items if isinstance(i, Chart)]
    tables = [
        dataclasses.replace(s, items=tuple(i for i in s.items if isinstance(i, Table)))
        for s in drawn
    ]
    page = render(analysis, tables)  # without what takes seconds to draw
    for text in ('yaw share 0 → 1', 'body orientation off → on', 'hidden units 32×32 → 64×64'):
        assert text in page
    assert 'task.yaw_share' in page
    assert 'which factors?' in page
    assert 'sensor' not in page.split('id="runs"')[0]
    assert not [chart.name for chart in charts if 'sensor' in f'{chart.title} {chart.caption}']
    assert 'IMU with fusion' in page  # the one factor with a device, by the letter of its sensor
    assert 'range finder' not in page


def test_a_level_that_its_run_did_not_have_is_no_silent_number(campaign, write_bag) -> None:
    row = read_rows(campaign / 'plan.csv')[0]
    other = row.spec.with_value('task.yaw_share', 0.5, 'test')
    shutil.rmtree(row.bag)
    described = dict(row.metadata) | {'spec': other.to_text()}
    write_bag(f'mixed/runs/{row.run_id}', samples=0, **described)
    (table,) = read_bags([campaign])  # its plan says which it is to be
    assert len(table.rows) == 15
    assert any('task.yaw_share 0.5, expected' in caveat for caveat in table.caveats)
    (campaign / 'plan.csv').unlink()
    with pytest.raises(BagError, match=r'task\.yaw_share 0\.5, expected .* factor .yaw share'):
        read_bags([campaign])


def test_runs_of_another_base_are_not_mixed_in(campaign, write_bag) -> None:
    row = read_rows(campaign / 'plan.csv')[0]
    other = row.spec.with_value('task.height_weight', 0.7, 'test')
    shutil.rmtree(row.bag)
    described = dict(row.metadata) | {'spec': other.to_text()}
    write_bag(f'mixed/runs/{row.run_id}', samples=0, **described)
    with pytest.raises(TableError, match=r'not alike .*task\.height_weight 0\.7'):
        read_bags([campaign])


def test_responses_are_by_the_set_of_high_levels(campaign: Path) -> None:
    found = bag_responses(campaign, 'final_average_reward')
    assert len(found) == 8
    assert {'(none)', 'ABCD'} < set(found)


def test_an_algorithm_is_a_factor_like_any_other(tmp_path: Path, write_bag) -> None:
    factors = tmp_path / 'factors.yaml'
    factors.write_text(
        '- {name: algorithm, key: learner.algorithm, low: ddpg, high: sac}\n'
        '- {name: foot contacts, key: observations.G, low: off, high: on}\n'
    )
    out = tmp_path / 'two' / 'plan.csv'
    swift = ['--set', 'learner.ddpg.update_ratio=0.125']
    plan.main(['--factors', str(factors), '--design', 'full', *swift, '--out', str(out)])
    rows = read_rows(out)
    for row in rows:
        described = dict(row.metadata) | {'spec': row.spec.to_text()}
        write_bag(f'two/runs/{row.run_id}', samples=0, gain=10.0 + row.levels[0], **described)
    (table,) = read_bags([out.parent])
    assert (len(table.rows), table.caveats) == (4, ())
    assert {row.spec.learner.algorithm for row in rows} == {'ddpg', 'sac'}
    for row in rows:
        assert row.bag_state(whole=True).other == 'episodes 3, expected 1000'
    # What the runs of one algorithm have in common is held against them as ever.
    other = next(row for row in rows if row.spec.learner.algorithm == 'ddpg')
    changed = other.spec.with_value('learner.ddpg.batch_size', 64, 'test').to_text()
    shutil.rmtree(other.bag)
    described = dict(other.metadata) | {'spec': changed}
    write_bag(f'two/runs/{other.run_id}', samples=0, **described)
    with pytest.raises(TableError, match=r'not alike .*learner\.ddpg\.batch_size 64'):
        read_bags([out.parent])


@pytest.mark.parametrize(
    ('key', 'value', 'message'),
    [
        ('A', 'high', "level A is 'high', expected -1 or 1"),
        ('factors', '- {name: a}', 'expected a list of factors'),
        ('factors', '3', 'expected a list of factors'),
        ('factors', '[', 'expected a list of factors'),
    ],
)
def test_a_foreign_bag_is_refused_in_one_line(campaign, write_bag, key, value, message) -> None:
    row = read_rows(campaign / 'plan.csv')[0]
    path = write_bag('elsewhere/odd', samples=0, **(dict(row.metadata) | {key: value}))
    with pytest.raises(BagError, match=message) as caught:
        bag_responses(path.parent, 'mean_return')
    assert '\n' not in str(caught.value)
