# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Short runs of the algorithms of stable-baselines3."""

from pathlib import Path

import pytest
from hexapod_agent.environment.env import HexapodLine
from hexapod_agent.learning import checkpoint
from hexapod_agent.learning.training import Trainer
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_agent.train import train_episode

SEED = 3
_GROUPS = {'batch_size': 32, 'buffer_size': 5000, 'update_every': 8, 'update_ratio': 0.5}
SECTIONS = {
    'td3': _GROUPS,
    'sac': _GROUPS,
    # A rollout ends amid an episode, and one at an end: 3 rollouts are 2 episodes.
    'ppo': {'rollout_steps': 40, 'batch_size': 20, 'epochs': 2},
}


def config_of(algorithm: str) -> RunSpec:
    """Return a specification of episodes of 60 steps."""
    return RunSpec.from_mapping(
        {
            'observations': 'ABCDE',
            'task': {'time_limit_steps': 60},
            'learner': {
                'algorithm': algorithm,
                algorithm: SECTIONS[algorithm] | {'hidden': [40, 30]},
            },
            'training': {'episodes': 4, 'evaluation': 1, 'final_rate': 0.5},
        },
        algorithm,
    )


def advance(trainer: Trainer, episodes: int) -> None:
    """Train on in the environment."""
    env = HexapodLine(config=trainer.config)
    for _ in range(episodes):
        train_episode(env, trainer)


@pytest.fixture(scope='session', params=SECTIONS)
def library_config(request) -> RunSpec:
    """A short run of each algorithm."""
    return config_of(request.param)


@pytest.fixture(scope='session')
def run_file(library_config, tmp_path_factory) -> Path:
    """The checkpoint of such a run after two episodes."""
    trainer = Trainer(library_config, SEED)
    advance(trainer, 2)
    path = tmp_path_factory.mktemp('run') / 'run.pt'
    checkpoint.save(path, trainer)
    return path


@pytest.fixture
def trainer(run_file) -> Trainer:
    """Such a run after two episodes."""
    return checkpoint.load(run_file)
