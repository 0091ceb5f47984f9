# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Runs for a fleet, and the same runs trained alone."""

from collections.abc import Callable
from functools import partial

import pytest
from hexapod_agent.environment.env import HexapodLine
from hexapod_agent.fleet.fleet import Fleet
from hexapod_agent.fleet.learners import Learners, SeparateLearners
from hexapod_agent.fleet.pool import Pool
from hexapod_agent.fleet.robots import Robots
from hexapod_agent.fleet.slot import Run
from hexapod_agent.fleet.stacked import StackedLearners
from hexapod_agent.learning.summary import EpisodeSummary
from hexapod_agent.learning.training import Trainer
from hexapod_agent.specification.observation import ObservationSpec
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_agent.train import evaluate, train_episode
from hexapod_sim.sensor_table import LETTERS


class NotedRun(Run):
    """Keeps what the fleet says of a run."""

    saves_next = True

    def __init__(self, trainer: Trainer, episodes: int) -> None:
        self.trainer, self.episodes = trainer, episodes
        self.summaries: list[EpisodeSummary] = []
        self.evaluation: list[EpisodeSummary] = []
        self.end: str | Exception = ''

    def episode_ended(self, summary: EpisodeSummary) -> None:
        self.summaries.append(summary)

    def evaluated(self, summary: EpisodeSummary) -> None:
        self.evaluation.append(summary)

    def ended(self) -> None:
        self.end = 'ended'

    def failed(self, error: Exception) -> None:
        self.end = error


@pytest.fixture(scope='session')
def full_config() -> RunSpec:
    """Networks and batches of the real size, and its arithmetic; episodes of 80 steps."""
    changes = {
        'task': {'time_limit_steps': 80},
        'ddpg': {'buffer_size': 5000},
        'training': {'evaluation': 1},
    }
    return RunSpec.from_mapping(changes, 'full_config')


@pytest.fixture(scope='session')
def library_configs() -> list[RunSpec]:
    """TD3, SAC and PPO with networks of the article's size; episodes of 40 steps."""
    groups = {'batch_size': 32, 'buffer_size': 5000, 'update_every': 8, 'update_ratio': 0.5}
    sections = {'td3': groups, 'sac': groups, 'ppo': {'rollout_steps': 30, 'batch_size': 15}}
    return [
        RunSpec.from_mapping(
            {
                'task': {'time_limit_steps': 40},
                'learner': {'algorithm': name, name: section},
                'training': {'evaluation': 1},
            },
            name,
        )
        for name, section in sections.items()
    ]


@pytest.fixture
def new_run() -> Callable[..., NotedRun]:
    def make(config: RunSpec, observations: str, seed: int, episodes: int = 2) -> NotedRun:
        return NotedRun(Trainer(config.observing(observations), seed), episodes)

    return make


@pytest.fixture
def train_alone() -> Callable[[NotedRun], NotedRun]:
    """What `train` does to a run."""

    def train(run: NotedRun) -> NotedRun:
        env = HexapodLine(run.trainer.spec.letters, run.trainer.config)
        while run.trainer.episode < run.episodes:
            run.episode_ended(train_episode(env, run.trainer))
        run.evaluation = list(evaluate(env, run.trainer))
        return run

    return train


@pytest.fixture
def train_fleet() -> Callable[..., Fleet]:
    """Train runs of one configuration in a fleet."""

    def train(
        runs: list[NotedRun], num_slots: int, threads: int = 2, stacked: bool = False
    ) -> Fleet:
        config = runs[0].trainer.config
        with Pool(threads) as pool:
            learners: Learners = (
                StackedLearners(config, ObservationSpec(LETTERS).size, num_slots, pool, 'cpu')
                if stacked
                else SeparateLearners(pool)
            )
            fleet = Fleet(Robots(num_slots), learners, pool, num_slots)
            fleet.train(partial(next, iter(runs), None))
        return fleet

    return train
