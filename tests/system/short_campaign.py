# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Campaigns of runs so short that a test can afford several."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pandas as pd
from hexapod_agent.environment.env import HexapodLine
from hexapod_agent.learning.training import Trainer
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_agent.train import train_episode
from hexapod_doe.bags.run_record import find_bags, read_run
from hexapod_doe.bags.verify import verify
from hexapod_doe.designs.plan_file import read_plan

SHORT = """
task: {time_limit_steps: 10}
ddpg: {batch_size: 8, buffer_size: 1000, update_every: 5}
actor: {hidden: [16, 16]}
critic: {hidden: [16, 16]}
training: {evaluation: 2, checkpoint_every: 2}
"""
TWO_RUNS = '--generators B=A --factors 2'
SIXTEEN_RUNS = '--generators E=ABCD --factors 5'
MANAGER = (
    'ros2 run hexapod_doe manager_node --ros-args -p plan:={plan} -p episodes:={episodes} '
    '-p record_every:=4 -p config:={config} -p local_workers:={workers}'
)


class ShortCampaign:
    """A campaign of short runs, in a folder of its own."""

    def __init__(self, shell, folder: Path, design: str, episodes: int) -> None:
        """Make its plan.

        Args:
            shell: that runs its commands.
            folder: for the campaign.
            design: generators and number of factors, as options of `plan`.
            episodes: of each run.
        """
        self.shell = shell
        self.episodes = episodes
        self.plan = folder / 'plan.csv'
        self.runs = folder / 'runs'
        self.config: Path = shell.directory / 'short.yaml'
        self.config.write_text(SHORT)
        made = shell.call(f'ros2 run hexapod_doe plan {design} --seed 3 --out {self.plan}')
        assert made.returncode == 0, made.stderr
        self.rows = read_plan(self.plan).rows

    def start(self, workers: int = 2, **parameters: object) -> subprocess.Popen[str]:
        """Start a manager with so many local workers."""
        line = MANAGER.format(
            plan=self.plan, episodes=self.episodes, config=self.config, workers=workers
        )
        return self.shell.start(
            line + ''.join(f' -p {name}:={value}' for name, value in parameters.items())
        )

    def results(self) -> dict[str, pd.DataFrame]:
        """Check that there is one whole bag per row; return their results, time stamps apart."""
        bags = find_bags(self.runs)
        assert sorted(bag.name for bag in bags) == sorted(self.rows['run_id'])
        for bag in bags:
            verify(bag)
        return {bag.name: read_run(bag).episodes.drop(columns='stamp_ns') for bag in bags}

    def assert_as_alone(self) -> None:
        """Compare every bag with what its run gives without graph, bags and campaign."""
        found = self.results()
        for _, row in self.rows.iterrows():
            expected = self._alone(row['observations'], row['seed'])
            columns = found[row['run_id']][list(expected.columns)]
            pd.testing.assert_frame_equal(columns, expected, check_dtype=False, check_exact=True)

    def _alone(self, observations: str, seed: int) -> pd.DataFrame:
        settings = RunSpec.load(self.config)
        trainer = Trainer(settings.observing(observations), seed)
        env = HexapodLine(observations, settings)
        summaries = [vars(train_episode(env, trainer)) for _ in range(self.episodes)]
        rows = [summary | summary['metrics'] for summary in summaries]
        return pd.DataFrame(rows).set_index('episode').drop(columns=['terms', 'metrics'])
