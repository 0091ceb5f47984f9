# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A row gives the same results in a fleet as on the graph, and may change between the two."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path

import pandas as pd
import pytest
from hexapod_agent.fleet.pool import Pool
from hexapod_agent.learning.player import Player
from hexapod_agent.learning.run_checkpoint import checkpoint_path
from hexapod_agent.learning.training import Trainer, TrainingDivergedError
from hexapod_agent.nodes.agent_node import AgentNode
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_cpg.nodes.cpg_node import CpgNode
from hexapod_doe.bags.run_record import read_run
from hexapod_doe.bags.verify import verify
from hexapod_doe.campaigns.fleet_row import FleetRow
from hexapod_doe.campaigns.row import Row
from hexapod_doe.designs.factor import sensors
from hexapod_doe.nodes.recorder_node import RecorderNode
from hexapod_doe.nodes.train_goal import train_goal
from hexapod_doe.run_fleet import build_fleet
from hexapod_sim.nodes.sim_node import SimNode

pytestmark = pytest.mark.graph
EPISODES = 5
SHORT = (
    'task: {time_limit_steps: 20}\nddpg: {batch_size: 8, update_every: 4}\n'
    'actor: {hidden: [16, 16]}\ncritic: {hidden: [16, 16]}\n'
    f'training: {{episodes: {EPISODES}, evaluation: 2, checkpoint_every: 2}}\n'
)


class Quiet:
    """Follows a row without a word, but for what should not happen."""

    def __init__(self) -> None:
        self.error: Exception | None = None

    def log(self, text: str) -> None:
        raise AssertionError(text)

    def episode(self, row, summary) -> None:
        """Say nothing."""

    def end(self, row, error) -> None:
        self.error = error


@pytest.fixture
def on_graph(graph) -> Callable[[Row], str]:
    """Return a function that has a worker train a row; what it returns is why that failed."""
    graph.add(SimNode(), CpgNode(), RecorderNode(), AgentNode())
    return lambda row: graph.train(train_goal(row, 0)).result.message


@pytest.fixture
def in_fleet() -> Callable[[Row], Exception | None]:
    """Return a function that has a fleet train a row; what it returns is why that failed."""

    def train(row: Row) -> Exception | None:
        watch = Quiet()
        with Pool(2) as pool:
            fleet = build_fleet([row.spec], 1, pool, 'cpu')
            runs = iter([FleetRow(row, 'cpu', watch)])
            fleet.train(partial(next, runs, None))
        return watch.error

    return train


@pytest.fixture
def row(tmp_path: Path) -> Callable[[str], Row]:
    base = RunSpec.from_text(SHORT, 'test')
    treatments = replace(sensors('BE'), base=base)
    return lambda name: Row('r', 'BE', 4, tmp_path / name, {'case': '3'}, treatments, (1, 1))


@pytest.fixture
def cut(monkeypatch) -> Callable[[int], None]:
    """Return a function that cuts runs in the middle of an episode."""
    act = Trainer.observe

    def at(episode: int) -> None:
        def observe(self, observation, outcome):
            if self.episode == episode and outcome.step == 10:
                raise TrainingDivergedError(f'cut in episode {episode}')
            return act(self, observation, outcome)

        monkeypatch.setattr(Trainer, 'observe', observe)

    return at


def results(row: Row) -> pd.DataFrame:
    verify(row.bag)
    return read_run(row.bag).episodes


def test_a_fleet_gives_the_results_of_the_graph(on_graph, in_fleet, row) -> None:
    assert on_graph(row('graph')) == ''
    assert in_fleet(row('fleet')) is None
    ours, theirs = results(row('fleet')), results(row('graph'))
    assert theirs['updates'].iloc[-1] == 20
    pd.testing.assert_frame_equal(ours, theirs, check_exact=True)
    fleet, worker = (read_run(row(name).bag) for name in ('fleet', 'graph'))
    kept, expected = fleet.metadata, worker.metadata
    for key in ('run_id', 'observations', 'seed', 'mode', 'episodes', 'spec', 'case', 'status'):
        assert kept[key] == expected[key]
    assert len(fleet.evaluation) == int(kept['evaluation']) == 2
    pd.testing.assert_frame_equal(fleet.evaluation, worker.evaluation, check_exact=True)
    mean = fleet.evaluation['average_return'].iloc[-1]
    assert float(kept['evaluation_return']) == float(expected['evaluation_return']) == mean


def test_either_goes_on_where_the_other_was_cut(on_graph, in_fleet, row, cut) -> None:
    assert in_fleet(row('whole')) is None
    cut(3)
    assert 'cut in episode 3' in str(in_fleet(row('first in fleet')))
    assert 'cut in episode 3' in on_graph(row('first on graph'))
    cut(-1)
    assert on_graph(row('first in fleet')) == ''
    assert in_fleet(row('first on graph')) is None
    whole = results(row('whole')).drop(columns='stamp_ns')
    for name in ('first in fleet', 'first on graph'):
        found = results(row(name)).drop(columns='stamp_ns')
        pd.testing.assert_frame_equal(found, whole, check_exact=True)
        assert read_run(row(name).bag).metadata['resumed'] == '2'
        assert not checkpoint_path(row(name).bag).exists()


def test_the_graph_goes_on_where_a_fleet_was_cut_amid_an_evaluation(
    on_graph, in_fleet, row, monkeypatch
) -> None:
    begin = Player.begin_episode

    def begin_first(self, episode: int) -> None:
        if episode == 1:
            raise TrainingDivergedError('cut in start 1')
        begin(self, episode)

    assert in_fleet(row('whole')) is None
    with monkeypatch.context() as patch:
        patch.setattr(Player, 'begin_episode', begin_first)
        assert 'cut in start 1' in str(in_fleet(row('cut')))
    assert on_graph(row('cut')) == ''
    verify(row('cut').bag)
    cut, whole = (read_run(row(name).bag) for name in ('cut', 'whole'))
    for ours, theirs in ((cut.episodes, whole.episodes), (cut.evaluation, whole.evaluation)):
        frames = [frame.drop(columns='stamp_ns') for frame in (ours, theirs)]
        pd.testing.assert_frame_equal(*frames, check_exact=True)
    assert cut.metadata['evaluation_return'] == whole.metadata['evaluation_return']
