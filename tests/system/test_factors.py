# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Factors of any key, from the plan over workers and a fleet to the report."""

from __future__ import annotations

import html
import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hexapod_agent.deployment import agent_file
from hexapod_doe.bags.run_identity import run_identity
from hexapod_doe.bags.run_record import RunRecord, read_run
from hexapod_doe.campaigns.row import read_rows

pytestmark = pytest.mark.system
MANAGER = (
    'ros2 launch hexapod_bringup campaign.launch.xml plan:=graph/plan.csv record_every:=0 '
    'local_workers:=2 set:=[task.line_y=0.1]'
)
BASE = """
task: {time_limit_steps: 24}
learner:
  actor: {hidden: [16, 16]}
  critic: {hidden: [16, 16]}
  ddpg: {batch_size: 8, update_every: 4}
training: {episodes: EPISODES, evaluation: 2, window: 4, checkpoint_every: 3}
"""
SENSORS = """
- {name: joint torques, key: observations.A, low: off, high: on}
- {name: body velocity, key: observations.B, low: off, high: on}
- {name: body orientation, key: observations.C, low: off, high: on}
- {name: body height, key: observations.E, low: off, high: on}
- {name: foot contacts, key: observations.G, low: off, high: on}
"""
OTHERS = """
- {name: share of closeness, key: task.closeness_weight, low: 0, high: 2}
- {name: IMU noise, key: sensors.imu_data.noise, low: 0, high: 0.1}
- {name: learning rate, key: learner.actor.learning_rate, low: 1e-4, high: 2e-3}
"""
EIGHT = (SENSORS + OTHERS, '--design sixteenth', 16, 8)
EIGHT_CHANGES = (
    'joint torques off → on',
    'body velocity off → on',
    'body orientation off → on',
    'body height off → on',
    'foot contacts off → on',
    'share of closeness 0 → 2',
    'IMU noise 0 → 0.1',
    'learning rate 0.0001 → 0.002',
)
EXAMPLE = Path(__file__).resolve().parents[2] / 'docs' / 'harder.yaml'
HARDER = (EXAMPLE.read_text(encoding='utf-8'), '--design eighth', 16, 4)
HARDER_CHANGES = (
    'learner ddpg → sac',
    'ground flat → rough',
    'payload 0 → 1.2',
    'closeness weight 2 → 4',
    'IMU noise 0 → 0.05',
    'body orientation off → on',
    'foot contacts off → on',
)
FEW = (
    """
- {name: body orientation, key: observations.C, low: off, high: on}
- {name: IMU noise, key: sensors.imu_data.noise, low: 0, high: 0.1}
- {name: layers, key: learner.actor.hidden, low: [16, 16], high: [8]}
""",
    '--design half',
    4,
    3,
)


def trained(shell, factors: str, design: str, rows: int, episodes: int) -> tuple[Path, Path]:
    """Have a plan trained by two workers and by a fleet; return their folders."""
    here = shell.directory
    (here / 'factors.yaml').write_text(factors)
    (here / 'base.yaml').write_text(BASE.replace('EPISODES', str(episodes)))
    line = f'ros2 run hexapod_doe plan --factors factors.yaml {design} --config base.yaml --seed 3'
    for folder in ('graph', 'fleet'):
        made = shell.call(f'{line} --out {folder}/plan.csv')
        assert made.returncode == 0, made.stderr
    lines = (
        MANAGER,
        'ros2 run hexapod_doe run_fleet --plan fleet/plan.csv --set task.line_y=0.1 --slots 3 '
        '--processes 1',
    )
    for line in lines:
        ended = shell.run(line, timeout_s=400.0)
        assert ended.returncode == 0, ended.stdout + ended.stderr
        assert f'{rows} of {rows} runs' in ended.stdout
    return here / 'graph', here / 'fleet'


def check_equal(graph: Path, fleet: Path) -> list[RunRecord]:
    """Both folders hold the same runs to the last bit, each of its row; return the runs."""
    records = []
    for row in read_rows(graph / 'plan.csv'):
        ours, theirs = (read_run(folder / 'runs' / row.run_id) for folder in (graph, fleet))
        expected = row.spec.with_value('task.line_y', 0.1, 'test')
        assert ours.metadata['spec'] == theirs.metadata['spec'] == expected.to_text()
        assert run_identity(ours.metadata) == run_identity(theirs.metadata)
        counts = ['stamp_ns', 'late', 'missing', 'duplicate', 'out_of_order']
        tables = [record.episodes.drop(columns=counts) for record in (ours, theirs)]
        pd.testing.assert_frame_equal(*tables, check_exact=True)
        assert ours.metadata['evaluation_return'] == theirs.metadata['evaluation_return']
        seen = np.random.default_rng(1).uniform(-1, 1, expected.observed.size).astype(np.float32)
        agents = [agent_file.load(f / 'runs' / f'{row.run_id}.pt') for f in (graph, fleet)]
        np.testing.assert_array_equal(*[agent.policy(seen) for agent in agents])
        records.append(ours)
    assert len({record.episodes['episode_return'].sum() for record in records}) == len(records)
    return records


def test_rows_that_differ_in_anything_are_trained_alike_by_workers_and_by_a_fleet(shell) -> None:
    graph, fleet = trained(shell, *FEW)
    check_equal(graph, fleet)
    again = shell.run('ros2 run hexapod_doe run_fleet --plan fleet/plan.csv')
    assert again.returncode == 2
    assert 'config.task.line_y 0.1, expected 0.0' in again.stderr


@pytest.mark.slow
@pytest.mark.timeout(900)
@pytest.mark.parametrize(
    ('factors', 'changes'),
    [(EIGHT, EIGHT_CHANGES), (HARDER, HARDER_CHANGES)],
    ids=['eight', 'seven'],
)
def test_sixteen_cases_from_plan_to_report(
    shell, factors: tuple[str, str, int, int], changes: tuple[str, ...]
) -> None:
    *_, rows, episodes = factors
    graph, fleet = trained(shell, *factors)
    records = check_equal(graph, fleet)
    assert len(records) == rows
    assert all(len(record.episodes) == episodes for record in records)
    ended = shell.run('ros2 run hexapod_doe analyze graph --out report', timeout_s=200.0)
    assert ended.returncode == 0, ended.stderr
    page = (shell.directory / 'report' / 'index.html').read_text(encoding='utf-8')
    report = ' '.join(html.unescape(re.sub('<[^>]+>', ' ', page)).split())
    for change in changes:
        assert change in report
