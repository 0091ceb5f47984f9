# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""An algorithm is a file and a row of the table: it is specified, trained, kept and resumed."""

import subprocess
import sys

import pytest
from hexapod_agent.deployment import agent_file
from hexapod_agent.environment.env import HexapodLine
from hexapod_agent.environment.evaluation import run_episode
from hexapod_agent.fleet.pool import Pool
from hexapod_agent.fleet.stacked import StackedLearners
from hexapod_agent.learning import checkpoint
from hexapod_agent.learning.training import Trainer
from hexapod_agent.specification.run_spec import ConfigError, RunSpec
from hexapod_agent.train import train_episode


def test_a_specification_has_the_sections_of_its_algorithm(search, small_config):
    assert search.to_mapping()['learner'] == {
        'algorithm': 'random_search', 'search': {'width': 0.5},
    }  # fmt: skip
    assert RunSpec.from_text(search.to_text(), 'its own text') == search
    wider = search.with_settings(['learner.search.width=0.75'])
    assert wider.differences(search) == {'learner.search.width': (0.75, 0.5)}
    with pytest.raises(ConfigError, match=r'learner.search.width is -1.0, expected: Input'):
        search.with_value('learner.search.width', -1.0, 'a test')
    with pytest.raises(ConfigError, match=r"unknown key 'learner.ddpg', .* algorithm, search"):
        search.with_value('learner.ddpg.discount', 0.9, 'a test')
    back = search.with_value('learner.algorithm', 'ddpg', 'a test')
    assert back.differences(small_config).keys() <= {
        f'learner.{key}' for key in (
            'actor.hidden', 'critic.hidden', 'ddpg.batch_size', 'ddpg.buffer_size',
            'ddpg.update_every', 'noise.decay',
        )
    }  # fmt: skip


@pytest.mark.parametrize('name', ['ppo2', '', 3, None, ['ddpg']])
def test_an_unknown_algorithm_is_one_clear_error(small_config, name):
    with pytest.raises(ConfigError, match=r'learner.algorithm is .*, expected one of ddpg, td3,'):
        small_config.with_value('learner.algorithm', name, 'a test')


def test_it_is_trained_resumed_and_played(search, tmp_path):
    trainer, env = Trainer(search.observing('B'), 1), HexapodLine(config=search.observing('B'))
    for _ in range(2):
        summary = train_episode(env, trainer)
    assert summary.metrics['best_return'] == pytest.approx(trainer.returns[0])  # a mean
    checkpoint.save(tmp_path / 'run.pt', trainer)
    best = max(trainer.returns)
    agent = agent_file.load(tmp_path / 'run.pt')
    played = run_episode(env, agent.policy, 1, trainer.returns.index(best))
    assert played.episode_return == best
    resumed = checkpoint.load(tmp_path / 'run.pt')
    for each in (resumed, trainer):
        train_episode(env, each)
    assert resumed.returns == trainer.returns


def test_an_algorithm_without_a_stack_is_refused_on_a_device(search):
    with Pool(1) as pool, pytest.raises(ConfigError, match='random_search, which learns on the'):
        StackedLearners(search, 100, 1, pool, 'cpu')


def test_a_specification_loads_no_torch():
    code = (
        'import sys; from hexapod_agent.specification.run_spec import RunSpec; RunSpec.load(); '
        'assert "torch" not in sys.modules'
    )
    subprocess.run([sys.executable, '-c', code], check=True)


def test_a_trainer_of_ddpg_sets_nothing_of_torch_and_loads_no_other_algorithm(
    small_config, tmp_path
):
    code = f"""
import sys
import torch
from hexapod_agent.deployment import agent_file
from hexapod_agent.learning import checkpoint
from hexapod_agent.learning.training import Trainer
from hexapod_agent.specification.run_spec import RunSpec
torch.set_num_threads(3)
checkpoint.save_agent('{tmp_path}/a.pt', Trainer(RunSpec.load(), 1))
agent_file.load('{tmp_path}/a.pt')
assert torch.get_num_threads() == 3
assert torch.get_float32_matmul_precision() == 'highest'
assert 'stable_baselines3' not in sys.modules
"""
    subprocess.run([sys.executable, '-c', code], check=True)
    assert Trainer(small_config, 1).learner.metric_names == ('critic_loss', 'actor_loss', 'mean_q')
