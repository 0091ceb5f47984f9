# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The trainer's bookkeeping, its determinism, and its refusal of numbers that are not finite."""

import numpy as np
import pytest
import torch
from hexapod_agent.algorithms.replay import Batch
from hexapod_agent.environment.env import HexapodLine
from hexapod_agent.learning.training import Trainer, TrainingDivergedError
from hexapod_agent.specification.run_spec import ConfigError, RunSpec
from hexapod_agent.train import train_episode
from hexapod_cpg.mapping import ACTION_SIZE
from hexapod_sim.task import Outcome


def outcome(step: int, reward: float = 1.0, **changes) -> Outcome:
    values = {'terminated': False, 'truncated': False, 'cause': ''} | changes
    return Outcome(step, reward, {'velocity': 0.25 * reward, 'alive': 0.75 * reward}, **values)


def observation(trainer, value: float = 0.0) -> np.ndarray:
    return np.full(trainer.spec.size, value, np.float32)


def play(trainer, rewards) -> None:
    """One episode with made-up observations and rewards."""
    trainer.begin_episode(trainer.episode)
    for step in range(len(rewards)):
        reward = rewards[step - 1] if step else 0.0
        trainer.observe(observation(trainer, step / 10), outcome(step, reward))
        trainer.learn()
    last = outcome(len(rewards), rewards[-1], terminated=True, cause='flipped')
    trainer.end_episode(observation(trainer, 0.9), last)


def test_summary_adds_up(make_trainer):
    trainer = make_trainer()
    play(trainer, [1.0, 2.0, 3.0])
    summary = trainer.summary
    assert (summary.episode, summary.steps, summary.episode_return) == (0, 3, 6.0)
    assert summary.terms == {'velocity': 1.5, 'alive': 4.5}
    assert (summary.terminated, summary.cause) == (True, 'flipped')
    assert summary.metrics['updates'] == 0
    assert np.isnan(summary.metrics['critic_loss'])
    play(trainer, [1.0] * 30)
    # A batch is 16: of the groups of 8 after steps 8, 16 and 24 the first finds 3 + 7 transitions.
    assert trainer.summary.metrics['updates'] == 16
    assert trainer.summary.average_return == trainer.average_return == (6.0 + 30.0) / 2
    assert np.isfinite(trainer.summary.metrics['critic_loss'])


@pytest.mark.parametrize(
    ('update_every', 'ratio', 'group'),
    [(1, 1, 1), (4, 1.0, 4), (7, 1.0, 7), (4, 0.25, 1), (7, 3, 21), (10, 0.1, 1)],
)
def test_updates_come_in_groups_by_their_ratio(small_config, update_every, ratio, group):
    ddpg = {'batch_size': 1, 'update_every': update_every, 'update_ratio': ratio}
    config = small_config.changed({'ddpg': ddpg}, 'a test')
    trainer = Trainer(config.observing('BC'), 1)
    play(trainer, [1.0])  # so that the first group of the next episode finds a batch
    trainer.begin_episode(1)
    due = []
    for step in range(28):
        trainer.observe(observation(trainer), outcome(step))
        due.append(trainer.learner.due)
    assert due[: 28 // update_every * update_every] == [*[0] * (update_every - 1), group] * (
        28 // update_every
    )


def test_learning_rates_fall_by_one_factor_to_the_last_episode(small_config):
    training = {'training': {'episodes': 5, 'final_rate': 0.0625}}
    trainer = Trainer(small_config.changed(training, 'a test').observing(''), 1)
    shares = []
    for trainer.episode in range(7):
        shares.append(trainer.rate_share)
    assert shares == pytest.approx([1.0, 0.5, 0.25, 0.125, 0.0625, 0.0625, 0.0625])


def test_a_falling_rate_moves_the_weights_less(small_config):
    moved = []
    for rate in (1.0, 1e-9):
        training = {'training': {'episodes': 2, 'final_rate': rate}}
        trainer = Trainer(small_config.changed(training, 'a test').observing(''), 1)
        env = HexapodLine('', trainer.config)
        train_episode(env, trainer)
        before = weights(trainer).clone()
        train_episode(env, trainer)
        moved.append((weights(trainer) - before).norm())
    assert moved[0] > 1e-3
    assert moved[1] < 1e-6 * moved[0]


def test_an_actor_waits_for_the_critic_and_then_learns(small_config):
    config = small_config.changed({'actor': {'waits': 1}}, 'a test')
    trainer = Trainer(config.observing(''), 1)
    env = HexapodLine('', trainer.config)
    networks = trainer.learner.networks
    parts = (networks.actor_parameters, networks.critic_parameters)
    moved = []
    for _ in range(3):
        before = [parameters.flat.clone() for parameters in parts]
        train_episode(env, trainer)
        after = [parameters.flat for parameters in parts]
        moved.append([not torch.equal(*pair) for pair in zip(before, after, strict=True)])
    # The critic has its first updates in the first episode; the actor follows at the next one.
    assert moved == [[False, True], [True, True], [True, True]]


def test_episodes_shorter_than_a_group_are_refused():
    config = RunSpec.from_mapping({'task': {'time_limit_steps': 20}}, 'a test')
    with pytest.raises(ConfigError, match=r'update_every is 24.* at most.* 20: nothing'):
        Trainer(config.observing(''), 1)


def test_window_of_the_average_return(make_trainer):
    trainer = make_trainer()
    trainer.returns = [0.0] * 100 + [1.0] * trainer.config.training.window
    assert trainer.average_return == 1.0


def test_actions_are_within_bounds_and_noisy(make_trainer):
    trainer = make_trainer()
    trainer.begin_episode(0)
    first = trainer.observe(observation(trainer), outcome(0))
    second = trainer.observe(observation(trainer), outcome(1))
    assert first.dtype == np.float32
    assert np.abs(second).max() <= 1.0
    assert not np.array_equal(first, second)


def test_reward_is_scaled_for_the_critic_and_not_for_the_report(small_config):
    ddpg = {'ddpg': {'reward_scale': 0.5, 'batch_size': 16, 'update_every': 1}}
    config = RunSpec.from_mapping(small_config.to_mapping() | ddpg, 'a test')
    trainer = Trainer(config.observing('BC'), 1)
    play(trainer, [2.0] * 20)
    batch = Batch.empty(1, 50, trainer.spec.size, ACTION_SIZE, torch.float32)
    trainer.learner.sample(batch)
    assert batch.reward.eq(1.0).all()
    assert trainer.summary.episode_return == 40.0


def test_episodes_come_in_order(make_trainer):
    with pytest.raises(ValueError, match='episode 3 cannot begin, expected episode 0'):
        make_trainer().begin_episode(3)


def weights(trainer) -> torch.Tensor:
    networks = trainer.learner.networks
    return torch.cat([networks.actor_parameters.flat, networks.critic_parameters.flat], 1)


def test_same_seed_same_weights(make_trainer, small_config):
    runs = []
    for seed in (5, 5, 6):
        trainer = make_trainer('BC', seed)
        env = HexapodLine('BC', small_config)
        for _ in range(3):
            train_episode(env, trainer)
        runs.append(trainer)
    assert torch.equal(weights(runs[0]), weights(runs[1]))
    assert runs[0].returns == runs[1].returns
    assert not torch.equal(weights(runs[0]), weights(runs[2]))


def test_observation_that_is_not_finite_names_channel_step_and_seed(make_trainer):
    trainer = make_trainer()
    trainer.begin_episode(0)
    trainer.observe(observation(trainer), outcome(0))
    bad = observation(trainer)
    bad[trainer.spec.size - 1] = np.nan
    message = r"'body orientation': orientation\[3\] is nan.*step 1 of episode 0, seed 5"
    with pytest.raises(TrainingDivergedError, match=message):
        trainer.observe(bad, outcome(1))


def test_reward_that_is_not_finite_is_named(make_trainer):
    trainer = make_trainer()
    trainer.begin_episode(0)
    trainer.observe(observation(trainer), outcome(0))
    with pytest.raises(TrainingDivergedError, match=r'reward is inf.*step 1 of episode 0, seed 5'):
        trainer.observe(observation(trainer), outcome(1, float('inf')))


def test_loss_that_is_not_finite_is_named(make_trainer):
    trainer = make_trainer()
    play(trainer, [1.0] * 20)
    trainer.learner.networks.critic_parameters.flat[0, 0] = float('nan')
    trainer.begin_episode(1)
    trainer.observe(observation(trainer), outcome(7))
    with pytest.raises(TrainingDivergedError, match=r'critic_loss.* is nan.*step 7 of episode 1'):
        trainer.learn()
