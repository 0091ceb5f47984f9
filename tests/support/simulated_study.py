# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Campaigns of known truth as folders with plans and bags, written without a training."""

from pathlib import Path

import numpy as np
import pandas as pd
from hexapod_agent.learning.summary import EpisodeSummary
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_doe.bags.episode_result import serialise
from hexapod_doe.bags.recording import Recording
from hexapod_doe.bags.rosbag2 import OfferedQos, Topic
from hexapod_doe.bags.run_bag import (
    EPISODE_RESULT,
    EVALUATION,
    EVALUATION_RETURN,
    EVALUATION_TOPIC,
    RESULT_TOPIC,
)
from hexapod_doe.campaigns.row import Row, read_rows
from hexapod_doe.designs.design import fraction
from hexapod_doe.designs.factor import Treatments, default_factors
from hexapod_doe.designs.plan_file import write_plan
from hexapod_doe.designs.plan_table import make_plan
from hexapod_doe.designs.plan_types import Confirmation
from simulated import Truth

EPISODES = 3
_STEPS, _EPISODE_NS = 600, 15_000_000_000
_RESULTS, _JUDGED = (
    Topic(f'/fleet/{name}', EPISODE_RESULT, (OfferedQos(depth=1000),))
    for name in (RESULT_TOPIC, EVALUATION_TOPIC)
)


def plan_campaign(folder: Path, design: str, replicates: int, *, in_turns: bool = False) -> Path:
    """Write the plan of a campaign of short trainings, and return its file."""
    base = RunSpec.load(None, [f'training.episodes={EPISODES}', 'training.evaluation=1'])
    plan = make_plan(
        fraction(design),
        replicates,
        in_turns=in_turns,
        confirmation=Confirmation(runs=2),
        treatments=Treatments(default_factors('ABCDEFG'), base),
    )
    write_plan(plan, folder / 'plan.csv')
    return folder / 'plan.csv'


def finish(plan: Path, truth: Truth, seed: int, rows: int | None = None) -> None:
    """Write a whole bag for each row of a plan, or for the first ones in its order."""
    rng = np.random.default_rng(seed)
    for row in read_rows(plan)[:rows]:
        levels = pd.DataFrame([row.levels], columns=list('ABCDEFG'))
        _write(row, float(truth.simulate(levels, rng)[0]))


def _write(row: Row, value: float) -> None:
    told = {
        **row.metadata, 'observations': row.spec.letters, 'seed': str(row.seed),
        'episodes': str(EPISODES), 'window': '1', EVALUATION: '1', 'spec': row.spec.to_text(),
        'git_commit': 'abc', 'processor': 'simulated', 'machine': 'none',
    }  # fmt: skip
    recording = Recording(row.run_id, row.bag, told, 25_000_000)
    for episode in range(EPISODES):
        earned = value * (episode + 1) / EPISODES
        recording.add_result(_RESULTS, _result(row, episode, earned), episode, _STEPS)
    recording.add_result(_JUDGED, _result(row, 0, value, after=EPISODES), 0, _STEPS)
    recording.finish(EPISODES, {EVALUATION_RETURN: repr(value)})


def _result(row: Row, episode: int, earned: float, after: int = 0) -> bytes:
    summary = EpisodeSummary(
        episode, _STEPS, earned, earned, {'velocity': earned}, False, 'time_limit', {}
    )
    return serialise(row.run_id, summary, (after + episode + 1) * _EPISODE_NS)
