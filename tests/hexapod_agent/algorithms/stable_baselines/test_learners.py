# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""TD3, SAC and PPO learn, resume to the last bit, and act without their library."""

import numpy as np
import onnxruntime
import pytest
import torch
from hexapod_agent.algorithms import ALGORITHMS
from hexapod_agent.algorithms.learner import Problem
from hexapod_agent.algorithms.stable_baselines.ppo import PpoLearner
from hexapod_agent.deployment import agent_file
from hexapod_agent.environment.env import HexapodLine
from hexapod_agent.learning import checkpoint
from hexapod_agent.learning.training import Trainer, problem_of
from hexapod_agent.specification.run_spec import ConfigError, RunSpec
from hexapod_agent.train import evaluate
from hexapod_sim.task import Outcome

from hexapod_agent import export

from .conftest import SEED, advance

# Of Fujimoto et al. 2018; Haarnoja et al. 2018; stable-baselines3.
RATES = {'td3': 1e-3, 'sac': 3e-4, 'ppo': 3e-4}


def leaves(value, path=''):
    """Yield every leaf of a nested state, by its path."""
    if isinstance(value, dict | list):
        pairs = value.items() if isinstance(value, dict) else enumerate(value)
        for key, part in pairs:
            yield from leaves(part, f'{path}/{key}')
    else:
        yield path, value


def assert_same(one: Trainer, other: Trainer) -> None:
    left, right = (dict(leaves(each.state_dict())) for each in (one, other))
    assert left.keys() == right.keys()
    for path, value in left.items():
        same = torch.equal(value, right[path]) if torch.is_tensor(value) else value == right[path]
        assert same, path


def stepped(trainer: Trainer, steps: int) -> None:
    """Take a trainer into the middle of an episode."""
    env = HexapodLine(config=trainer.config)
    seen, _ = env.reset(seed=trainer.seed, options={'episode': trainer.episode})
    trainer.begin_episode(trainer.episode)
    for _ in range(steps):
        action = trainer.observe(seen, env.outcome)
        trainer.learn()
        seen = env.step(action)[0]


def test_it_learns_and_resumes_to_the_last_bit(library_config, run_file):
    whole = Trainer(library_config, SEED)
    advance(whole, 2)
    assert whole.summary.metrics['updates'] > 0
    assert whole.learner.metric_names[:2] == ('critic_loss', 'actor_loss')
    assert_same(checkpoint.load(run_file), whole)
    stepped(whole, 45)  # the process dies there; PPO has learned meanwhile
    resumed, uncut = checkpoint.load(run_file), Trainer(library_config, SEED)
    advance(resumed, 2)
    advance(uncut, 4)
    assert resumed.returns == uncut.returns
    assert repr(resumed.summary) == repr(uncut.summary)
    assert_same(resumed, uncut)
    parameters = resumed.learner.state_dict()['model']['parameters']
    optimizers = [state for name, state in parameters.items() if 'optimizer' in name]
    rates = {group['lr'] for state in optimizers for group in state['param_groups']}
    assert rates == {0.5 * RATES[library_config.learner.algorithm]}  # of the last episode


def test_an_episode_that_was_left_is_dropped(library_config):
    trainer = Trainer(library_config, SEED)
    stepped(trainer, 10)
    advance(trainer, 2)
    assert trainer.episode == 2
    rollout = getattr(trainer.learner, '_rollout', None)
    if rollout is None:
        assert (
            len(trainer.learner._replay) == 9 + 2 * 60
        )  # what the tenth action led to was not seen
    else:  # 120 steps are three rollouts, the third of which is not learned from yet
        assert (rollout.pos, rollout.full) == (40, True)
        assert rollout.episode_starts[:, 0].tolist() == [0.0] * 40


def test_nothing_is_drawn_from_generators_that_others_share(trainer):
    torch.manual_seed(99)
    np.random.seed(99)
    other, before = Trainer(trainer.config, SEED), torch.get_rng_state()
    another = Trainer(trainer.config, SEED + 1)
    assert torch.equal(torch.get_rng_state(), before)
    first, second = (each.learner.policy().layers[0][0] for each in (other, another))
    assert not np.array_equal(first, second)
    advance(other, 2)
    assert_same(other, trainer)


def test_its_policy_is_the_librarys(trainer):
    learner = trainer.learner
    model = learner._model if isinstance(learner, PpoLearner) else learner.model
    generator = np.random.default_rng(0)
    for _ in range(20):
        seen = generator.uniform(-1.0, 1.0, trainer.spec.size).astype(np.float32)
        expected, _ = model.policy.predict(seen, deterministic=True)
        # Sums of 400 float32 in another order.
        np.testing.assert_allclose(learner.act(seen, explore=False), expected, atol=1e-5)
        assert np.abs(learner.act(seen, explore=True)).max() <= 1.0
    drawn = np.array([learner.act(seen, explore=True) for _ in range(50)])
    assert drawn.dtype == np.float32
    assert drawn.std(axis=0).min() > 0.01


def test_it_begins_at_its_level(library_config):
    """Every action is worth 530 at first, a tenth of it to critics; the weights add a little."""
    trainer = Trainer(library_config, SEED)
    learner, size = trainer.learner, trainer.spec.size
    seen = torch.rand(20, size, generator=torch.Generator().manual_seed(1)) * 2.0 - 1.0
    if isinstance(learner, PpoLearner):
        values = [learner._model.policy.predict_values(seen)]
    else:
        action = torch.zeros(20, learner.output.size)
        critics = learner.model.critic, learner.model.critic_target
        values = [value for critic in critics for value in critic(seen, action)]
    for value in values:
        assert (value - 53.0).abs().max() < 3.0


def test_sac_begins_with_its_spread():
    config = RunSpec.load(None, ['learner.algorithm=sac', 'learner.sac.deviation=0.2'])
    learner = Trainer(config.observing('ABCDE'), SEED).learner
    seen = np.zeros(config.observing('ABCDE').observed.size, np.float32)
    drawn = np.arctanh([learner.act(seen, explore=True) for _ in range(2000)])
    # The layer's weights spread it by a few hundredths of its logarithm; 2000 draws by 2 %.
    assert np.exp(np.log(drawn.std(axis=0)).mean()) == pytest.approx(0.2, rel=0.1)


def test_its_agent_acts_from_a_file_and_as_onnx(trainer, tmp_path):
    policy = trainer.learner.policy()
    # Actions of every size, also at the limits: PPO's output layer is drawn small.
    policy.layers[-1][0][:] *= 40.0 if policy.squash else 400.0
    checkpoint.save_agent(tmp_path / 'agent.pt', trainer)
    agent = agent_file.load(tmp_path / 'agent.pt')
    assert agent.config == trainer.config
    export.main([str(tmp_path / 'agent.pt'), str(tmp_path / 'agent.onnx')])
    session = onnxruntime.InferenceSession(
        tmp_path / 'agent.onnx', providers=['CPUExecutionProvider']
    )
    generator = np.random.default_rng(0)
    most = 0.0
    for _ in range(20):
        parts = {key: generator.uniform(-1.0, 1.0, size) for key, size in agent.spec.sizes.items()}
        seen = agent.spec.assemble(parts, parts['previous_action'])
        action = agent.policy(seen)
        np.testing.assert_array_equal(action, policy(seen))
        (exported,) = session.run(None, {key: part[None] for key, part in parts.items()})
        np.testing.assert_allclose(exported[0], action, atol=1e-3)  # 400 times a sum's rounding
        most = max(most, float(np.abs(action).max()))
    assert 0.9 < most <= 1.0
    *_, judged = evaluate(HexapodLine(config=trainer.config), trainer)
    assert np.isfinite(judged.average_return)


def test_ppo_bootstraps_where_time_ended_an_episode_and_not_after_a_fall():
    """Advantages are what the library's own loop gives, by the same rows."""
    config = RunSpec.load(None, [
        'learner.algorithm=ppo', 'learner.ppo.rollout_steps=4', 'learner.ppo.batch_size=4',
        'learner.ppo.reward_scale=1', 'learner.ppo.trace=1', 'learner.ppo.epochs=1',
    ]).learner  # fmt: skip
    returns, values = [], []
    for terminated in (False, True):
        learner = PpoLearner(config, Problem(5, 2, 0.025, 2, 'float32'), SEED)
        network, seen = learner._model.policy, np.eye(5, dtype=np.float32)
        value = network.predict_values(torch.from_numpy(seen)).detach().numpy()[:, 0]
        kept = learner._rollout.reset
        learner._rollout.reset = lambda learner=learner, kept=kept: (
            returns.append(learner._rollout.returns.flatten().copy()), kept())  # fmt: skip
        for start in (0, 2, 4):  # rows 0 to 3, and one that is pending
            learner.begin_episode(1.0)
            learner.store(seen[start], Outcome(0, 0.0, {}, False, False, ''))
            for step in (1, 2):
                learner.act(seen[(start + step - 1) % 5], explore=True)
                learner.update()
                over = step == 2
                ended = Outcome(step, 1.0, {}, terminated and over, over and not terminated, '')
                learner.store(seen[(start + step) % 5], ended)
        values.append(value)
    discount = 0.99
    cut, fallen = (found for found in returns)
    last = [values[0][2], values[0][4]]  # what is observed where the episodes end
    expected = [1 + discount * (1 + discount * value) for value in last]
    np.testing.assert_allclose(cut[[0, 2]], expected, rtol=1e-5)
    np.testing.assert_allclose(fallen[[0, 2]], [1 + discount] * 2, rtol=1e-5)


def test_values_that_do_not_go_together_are_refused(library_config):
    name = library_config.learner.algorithm
    broken = {'ppo': ('rollout_steps', 41, 'expected a multiple of learner.ppo.batch_size, 20'),
              'td3': ('update_ratio', 0.3, 'learner.td3.update_ratio is 0.3, expected a multiple'),
              'sac': ('update_ratio', 0.3, 'learner.sac.update_ratio is 0.3, expected a multiple'),
              }[name]  # fmt: skip
    with pytest.raises(ConfigError, match=broken[2]):
        library_config.with_value(f'learner.{name}.{broken[0]}', broken[1], 'a test')
    with pytest.raises(ConfigError, match=f"'bfloat16', which learner.algorithm {name} does not"):
        library_config.with_value('training.precision', 'bfloat16', 'a test')
    if name != 'ppo':
        rare = library_config.with_value(f'learner.{name}.update_every', 80, 'a test')
        with pytest.raises(ConfigError, match=f'learner.{name}.update_every is 80, expected at'):
            Trainer(rare, SEED)


def test_sections_are_those_of_the_algorithm_in_any_order(library_config):
    name = library_config.learner.algorithm
    settings = [f'learner.{name}.learning_rate=2e-3', f'learner.algorithm={name}']
    spec = RunSpec.load(None, settings)
    assert RunSpec.load(None, reversed(settings)) == spec
    assert spec.value(f'learner.{name}.learning_rate') == 2e-3
    assert spec.value(f'learner.{name}.hidden') == (400, 300)
    assert RunSpec.from_text(spec.to_text(), 'its own text') == spec
    assert 'ddpg' not in spec.to_mapping()['learner']
    assert problem_of(spec).observation_size == 79
    assert ALGORITHMS[name].stack is None
