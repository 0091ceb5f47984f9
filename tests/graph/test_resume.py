# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A run that was cut goes on from its checkpoint, and gives the results of one that was not."""

from __future__ import annotations

import shutil
import zlib
from collections.abc import Callable
from pathlib import Path

import pandas as pd
import pytest
from hexapod_agent.learning.player import Player
from hexapod_agent.learning.run_checkpoint import checkpoint_path
from hexapod_agent.learning.training import Trainer
from hexapod_agent.nodes.agent_node import AgentNode
from hexapod_cpg.nodes.cpg_node import CpgNode
from hexapod_doe.bags.bag_state import is_complete
from hexapod_doe.bags.run_record import read_run, read_topic
from hexapod_doe.bags.verify import verify
from hexapod_doe.nodes.recorder_node import RecorderNode
from hexapod_interfaces.action import TrainRun
from hexapod_sim.nodes.sim_node import SimNode

pytestmark = pytest.mark.graph
EPISODES = 6
EVERY = 2


DDPG = (
    'learner: {ddpg: {batch_size: 8, update_every: 4}, '
    'actor: {hidden: [16, 16]}, critic: {hidden: [16, 16]}}'
)
SAC = 'learner: {algorithm: sac, sac: {hidden: [16, 16], batch_size: 8, update_every: 4}}'
# A rollout ends amid an episode, and amid what is repeated after a cut.
PPO = 'learner: {algorithm: ppo, ppo: {hidden: [16, 16], rollout_steps: 30, batch_size: 10}}'


class CutError(RuntimeError):
    """Stands for whatever ends a run."""


@pytest.fixture
def learner() -> str:
    """Return the learner's section of the specification."""
    return DDPG


@pytest.fixture
def goal(tmp_path: Path, spec, learner: str) -> Callable[..., TrainRun.Goal]:
    """Return a function that makes the goal of a short run, a checkpoint every two episodes."""
    (tmp_path / 'short.yaml').write_text(
        f'task: {{time_limit_steps: 20}}\n{learner}\n'
        f'training: {{evaluation: 2, checkpoint_every: {EVERY}}}\n'
    )

    def make(name: str, **changes) -> TrainRun.Goal:
        fields = {
            'run_id': 'r',
            'spec': spec('BE', EPISODES, tmp_path / 'short.yaml'),
            'seed': 4,
            'bag': str(tmp_path / name),
            'record_every': 2,
            'resume': True,
        }
        return TrainRun.Goal(**fields | changes)

    return make


class Worker:
    """The nodes of a worker, whose run can be cut when so many episodes have begun."""

    def __init__(self, graph) -> None:
        self.cut_at = EPISODES
        self.cut_start = -1
        """Episode of the evaluation."""
        self.begun: list[int] = []
        graph.add(SimNode(), CpgNode(), RecorderNode(), AgentNode(self._make_trainer))

    def _make_trainer(self, *args) -> Trainer:
        worker = self

        class Cut(Trainer):
            def begin_episode(self, episode: int) -> None:
                worker.begun.append(episode)
                super().begin_episode(episode)

            def observe(self, observation, outcome):
                if self.episode == worker.cut_at and outcome.step == 10:
                    raise CutError(f'cut in episode {self.episode}')
                return super().observe(observation, outcome)

            def evaluator(self) -> Player:
                player = super().evaluator()
                begin = player.begin_episode

                def begin_unless_cut(start: int) -> None:
                    if start == worker.cut_start:
                        raise CutError(f'cut in start {start}')
                    begin(start)

                player.begin_episode = begin_unless_cut
                return player

        return Cut(*args)


@pytest.fixture
def worker(graph, monkeypatch) -> Worker:
    made = Worker(graph)
    # A trainer that comes from a checkpoint is watched as well.
    monkeypatch.setattr('hexapod_agent.learning.checkpoint.Trainer', made._make_trainer)
    return made


def results(bag: Path) -> pd.DataFrame:
    return read_run(bag).episodes.drop(columns='stamp_ns')


def train(graph, goal: TrainRun.Goal) -> str:
    return graph.train(goal).result.message


@pytest.fixture(scope='module')
def whole(tmp_path_factory) -> Path:
    """Return the folder where the undisturbed bag of each learner is kept, once there is one."""
    return tmp_path_factory.mktemp('whole')


@pytest.fixture
def undisturbed(
    graph, worker: Worker, goal, learner: str, whole: Path, tmp_path: Path
) -> pd.DataFrame:
    """Return the results of a run without a cut, whose bag is `whole`."""
    kept = whole / str(zlib.crc32(learner.encode()))
    if not kept.exists():
        assert train(graph, goal('whole')) == ''
        worker.begun.clear()
        shutil.copytree(tmp_path / 'whole', kept)
    shutil.copytree(kept, tmp_path / 'whole', dirs_exist_ok=True)
    return results(kept)


@pytest.mark.parametrize('learner', [DDPG, SAC, PPO], ids=['ddpg', 'sac', 'ppo'])
def test_a_cut_run_repeats_what_followed_its_checkpoint_and_no_more(
    graph, worker: Worker, goal, tmp_path: Path, undisturbed: pd.DataFrame
) -> None:
    bag = tmp_path / 'cut'
    for cut_at in (3, 5):
        worker.cut_at = cut_at
        assert f'cut in episode {cut_at}' in train(graph, goal('cut'))
        assert checkpoint_path(bag).exists()
        assert not is_complete(bag)
    worker.cut_at = EPISODES
    assert train(graph, goal('cut')) == ''
    assert worker.begun == [0, 1, 2, 3, 2, 3, 4, 5, 4, 5]
    pd.testing.assert_frame_equal(results(bag), undisturbed, check_exact=True)
    verify(bag)
    assert not checkpoint_path(bag).exists()
    metadata, whole = (read_run(tmp_path / name).metadata for name in ('cut', 'whole'))
    assert metadata['resumed'] == '4'
    for key in ('counts', 'sampled_episodes', 'incomplete', 'episodes'):
        assert metadata[key] == whole[key]
    stamps = [stamp for stamp, _ in read_topic(bag, 'joint_states')]
    assert stamps == sorted(stamps)
    assert len(stamps) == len(set(stamps)) == 3 * 21


def test_a_run_that_was_cut_amid_its_evaluation_gives_the_same(
    graph, worker: Worker, goal, tmp_path: Path, undisturbed: pd.DataFrame
) -> None:
    worker.cut_start = 1
    assert 'cut in start 1' in train(graph, goal('cut'))
    assert not is_complete(tmp_path / 'cut')
    worker.cut_start = -1
    assert train(graph, goal('cut')) == ''
    pd.testing.assert_frame_equal(results(tmp_path / 'cut'), undisturbed, check_exact=True)
    verify(tmp_path / 'cut')
    cut, whole = (read_run(tmp_path / name) for name in ('cut', 'whole'))
    assert cut.metadata['evaluation_return'] == whole.metadata['evaluation_return']
    evaluations = [run.evaluation.drop(columns='stamp_ns') for run in (cut, whole)]
    assert len(evaluations[0]) == 2
    pd.testing.assert_frame_equal(*evaluations, check_exact=True)


def test_without_resume_a_run_begins_anew(
    graph, worker: Worker, goal, tmp_path: Path, undisturbed: pd.DataFrame
) -> None:
    worker.cut_at = 3
    assert 'cut in episode' in train(graph, goal('cut', resume=False))
    worker.cut_at = EPISODES
    # The recorder of the worker that gave up still holds the bag; it is the same one.
    assert train(graph, goal('cut', resume=False)) == ''
    assert worker.begun[4:] == list(range(EPISODES))
    pd.testing.assert_frame_equal(results(tmp_path / 'cut'), undisturbed, check_exact=True)


@pytest.mark.parametrize(
    'harm', ['no recording', 'cut checkpoint', 'flipped bit', 'other configuration']
)
def test_a_run_that_cannot_go_on_begins_anew(
    graph, worker: Worker, goal, tmp_path: Path, undisturbed: pd.DataFrame, harm: str
) -> None:
    worker.cut_at = 3
    bag = tmp_path / 'cut'
    assert 'cut in episode' in train(graph, goal('cut'))
    if harm == 'no recording':
        (tmp_path / 'cut.partial').rename(tmp_path / 'elsewhere')
    elif harm == 'cut checkpoint':
        content = checkpoint_path(bag).read_bytes()
        checkpoint_path(bag).write_bytes(content[: len(content) // 2])
    elif harm == 'flipped bit':
        content = checkpoint_path(bag).read_bytes()
        at = content.index(b'observations')
        checkpoint_path(bag).write_bytes(content[:at] + b'O' + content[at + 1 :])
    else:
        assert 'cut in episode' in train(graph, goal('cut', seed=5, resume=False))
    worker.cut_at = EPISODES
    worker.begun.clear()
    assert train(graph, goal('cut')) == ''
    assert worker.begun == list(range(EPISODES))
    pd.testing.assert_frame_equal(results(bag), undisturbed, check_exact=True)


def test_a_checkpoint_is_taken_after_its_episodes_are_on_the_disk(
    graph, worker: Worker, goal, monkeypatch
) -> None:
    order: list[str] = []
    monkeypatch.setattr(
        'hexapod_doe.bags.bag_writer.os.fsync', lambda descriptor: order.append('disk')
    )
    monkeypatch.setattr(
        'hexapod_agent.learning.run_checkpoint.keep',
        lambda bag, trainer: order.append('checkpoint'),
    )
    assert train(graph, goal('r')) == ''
    first = order.index('checkpoint')
    assert 'disk' in order[:first]
    assert order.count('checkpoint') == 2
    assert 'disk' in order[first + 1 : order.index('checkpoint', first + 1)]
