# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Whatever process of a campaign is killed, and when: its bags are those of one left alone."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pandas as pd
import pytest
from hexapod_agent.config import AgentConfig
from hexapod_agent.env import HexapodLine
from hexapod_agent.observation import ObservationSpec
from hexapod_agent.train import train_episode
from hexapod_agent.training import Trainer
from hexapod_doe.bags.run_record import find_bags, read_run
from hexapod_doe.bags.verify import verify
from hexapod_doe.designs.plan_file import read_plan

from .storm import Storm

pytestmark = pytest.mark.system
SHORT = """
task: {time_limit_steps: 10}
ddpg: {batch_size: 8, buffer_size: 1000}
actor: {hidden: [16, 16]}
critic: {hidden: [16, 16]}
training: {checkpoint_every: 2}
"""
MANAGER = (
    'ros2 run hexapod_doe manager_node --ros-args -p plan:={plan} -p episodes:={episodes} '
    '-p record_every:=4 -p config:={config} -p local_workers:=2'
)


class Folder:
    """A campaign of short runs."""

    def __init__(self, shell, name: str, generators: str, episodes: int) -> None:
        self.shell = shell
        self.plan: Path = shell.directory / name / 'plan.csv'
        self.runs = self.plan.parent / 'runs'
        config = shell.directory / 'short.yaml'
        config.write_text(SHORT)
        made = shell.run(f'ros2 run hexapod_doe plan {generators} --seed 3 --out {self.plan}')
        assert made.returncode == 0, made.stderr
        self.rows = read_plan(self.plan).rows
        self.line = MANAGER.format(plan=self.plan, episodes=episodes, config=config)

    def start(self) -> subprocess.Popen[str]:
        return self.shell.start(self.line)

    def results(self) -> dict[str, pd.DataFrame]:
        """Check that there is one whole bag per row; return their results, time stamps apart."""
        bags = find_bags(self.runs)
        assert sorted(bag.name for bag in bags) == sorted(self.rows['run_id'])
        for bag in bags:
            verify(bag)
        return {bag.name: read_run(bag).episodes.drop(columns='stamp_ns') for bag in bags}


def assert_equal(found: dict[str, pd.DataFrame], expected: dict[str, pd.DataFrame]) -> None:
    assert found.keys() == expected.keys()
    for run_id, results in expected.items():
        pd.testing.assert_frame_equal(found[run_id], results, check_exact=True)


def weather(folder: Folder, kills: int, seed: int) -> Storm:
    """Let a storm pass over a campaign, then let the campaign come to its end."""
    storm = Storm(folder.start, folder.runs, seed)
    for _ in range(kills):
        storm.strike()
    assert storm.manager.wait(200.0) == 0, folder.shell.output()
    return storm


def trained_alone(row: pd.Series, config: Path, episodes: int) -> pd.DataFrame:
    """Return what a run gives in the environment, without graph, bags or campaign."""
    settings = AgentConfig.load(config)
    trainer = Trainer(ObservationSpec(row['observations']), settings, row['seed'])
    env = HexapodLine(row['observations'], settings)
    summaries = [vars(train_episode(env, trainer)) for _ in range(episodes)]
    return pd.DataFrame(summaries).set_index('episode').drop(columns='terms')


def test_three_kills_change_no_result(shell) -> None:
    folder = Folder(shell, 'campaign', '--generators C=AB --factors 3', 10)
    weather(folder, kills=3, seed=1)
    found = folder.results()
    for _, row in folder.rows.iterrows():
        expected = trained_alone(row, shell.directory / 'short.yaml', 10)
        columns = found[row['run_id']][list(expected.columns)]
        pd.testing.assert_frame_equal(columns, expected, check_dtype=False, check_exact=True)


@pytest.mark.slow
@pytest.mark.timeout(1800)
def test_fifty_kills_change_no_result(shell, capsys) -> None:
    calm = Folder(shell, 'calm', '--generators E=ABCD --factors 5', 16)
    assert calm.start().wait(300.0) == 0, shell.output()
    folder = Folder(shell, 'stormy', '--generators E=ABCD --factors 5', 16)
    storm = weather(folder, kills=50, seed=2026)
    found = folder.results()
    assert len(found) == 16
    assert_equal(found, calm.results())
    cut = len(list(folder.runs.glob('*.cut_*')))
    with capsys.disabled():
        print(f'\nkilled: {dict(storm.killed)}; recordings cut: {cut}; 16 of 16 bags equal')
