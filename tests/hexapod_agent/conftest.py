# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Small runs that several test modules train."""

from pathlib import Path

import pytest
from hexapod_agent.algorithms import ALGORITHMS, Algorithm
from hexapod_agent.learning.training import Trainer
from hexapod_agent.specification.run_spec import RunSpec


@pytest.fixture(scope='session')
def small_config() -> RunSpec:
    """Episodes of 40 steps, tiny networks."""
    changes = {
        'task': {'time_limit_steps': 40},
        'actor': {'hidden': [16, 12]},
        'critic': {'hidden': [16, 12]},
        'ddpg': {'batch_size': 16, 'buffer_size': 5000, 'update_every': 8},
        'noise': {'decay': 1e-4},
        'training': {'evaluation': 2},
    }
    return RunSpec.from_mapping(changes, 'small_config')


@pytest.fixture(scope='session')
def switched_config(small_config) -> RunSpec:
    """Small, with every switch of the learner on."""
    changes = {
        'actor': {'waits': 1},
        'ddpg': {'update_ratio': 0.5, 'n_step': 3},
        'training': {'episodes': 4, 'final_rate': 0.2},
    }
    return small_config.changed(changes, 'switched_config')


@pytest.fixture
def make_trainer(small_config):
    def make(observations: str = 'BC', seed: int = 5, config: RunSpec = small_config) -> Trainer:
        return Trainer(config.observing(observations), seed)

    return make


@pytest.fixture
def search(small_config, monkeypatch) -> RunSpec:
    """A specification of the algorithm in examples/random_search.py."""
    monkeypatch.syspath_prepend(Path(__file__).parents[2] / 'examples')
    names = (f'random_search:{name}' for name in ('RandomSearchConfig', 'RandomSearch'))
    monkeypatch.setitem(ALGORITHMS, 'random_search', Algorithm(*names))
    return small_config.with_value('learner.algorithm', 'random_search', 'a test')
