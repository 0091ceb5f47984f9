# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The environment is what Gymnasium expects, repeatable, and free of torch."""

import subprocess
import sys
import warnings

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from hexapod_agent.env import HexapodLine
from hexapod_agent.observation import CHANNELS, LETTERS, ObservationError
from hexapod_cpg.mapping import READINGS
from hexapod_sim.task import episode_seed

ID = 'hexapod_agent:HexapodLine-v0'


def test_tables_of_the_docstring_are_those_of_the_code():
    """Counts, scales and units of the observation, value and half width of the actions."""
    rows = [line.strip().strip('|').split('|') for line in HexapodLine.__doc__.splitlines()]
    cells = [[cell.strip() for cell in row] for row in rows if len(row) == 5]
    letters = ('always', *LETTERS)
    told = [(row[0].replace('always', ''), *row[2:]) for row in cells if row[0] in letters]
    table = [
        (channel.letter, str(size), f'{scale:g}', unit)
        for channel in CHANNELS
        for size, scale, unit in zip(channel.sizes, channel.scales, channel.units, strict=True)
    ]
    assert told[:2] == [('', '18', '1', 'rad'), ('', '18', '6.2', 'rad/s')]
    assert told == table
    told = [tuple(map(float, row[2:4])) for row in cells if row[0].startswith('5 i')]
    cpg = HexapodLine().config.cpg
    assert told == [getattr(cpg.ranges, name) for name in READINGS[cpg.reading]]


def walk(env: HexapodLine, steps: int, seed: int = 0) -> tuple[np.ndarray, list[float]]:
    generator = np.random.default_rng(seed)
    observations, rewards = [], []
    for _ in range(steps):
        action = generator.uniform(-1, 1, 30).astype(np.float32)
        observation, reward, *_ = env.step(action)
        observations.append(observation)
        rewards.append(reward)
    return np.array(observations), rewards


@pytest.mark.parametrize('observations', ['', 'ABCDE', 'ABCDEFG'])
def test_check_env_has_no_complaint(observations):
    with warnings.catch_warnings():
        warnings.simplefilter('error')
        env = gymnasium.make(ID, observations=observations)
        check_env(env.unwrapped, skip_render_check=True)


def test_same_seed_and_actions_give_the_same_bits():
    env = HexapodLine('ABCDEFG')
    env.reset(seed=3)
    first = walk(env, 60)
    walk(env, 10, seed=9)
    env.reset(seed=3)
    second = walk(env, 60)
    np.testing.assert_array_equal(first[0], second[0])
    assert first[1] == second[1]


def test_resets_count_the_episodes_of_a_run():
    env, other = HexapodLine(), HexapodLine()
    starts = [env.reset(seed=3)[0], env.reset()[0], env.reset()[0]]
    offset = np.random.default_rng(episode_seed(3, 2)).uniform(-0.5, 0.5)
    assert starts[2][78] == pytest.approx(offset, abs=1e-6)
    direct, _ = other.reset(seed=3, options={'episode': 2})
    np.testing.assert_array_equal(starts[2], direct)
    assert not np.array_equal(starts[0], starts[1])


def test_channels_do_not_change_the_physics():
    rewards = []
    for observations in ('', 'ABCDEFG'):
        env = HexapodLine(observations)
        env.reset(seed=1)
        rewards.append(walk(env, 40)[1])
    assert rewards[0] == rewards[1]


def test_previous_action_is_observed():
    env = HexapodLine()
    assert not env.reset(seed=1)[0][48:78].any()
    action = np.linspace(-1, 1, 30, dtype=np.float32)
    np.testing.assert_array_equal(env.step(action)[0][48:78], action)


def test_time_limit_truncates(small_config):
    env = HexapodLine('', small_config)
    env.reset(seed=1)
    for step in range(1, 41):
        *_, terminated, truncated, info = env.step(np.zeros(30, np.float32))
        assert (terminated, truncated) == (False, step == 40)
    assert info['cause'] == 'time_limit'
    assert info['joint_targets'].shape == (5, 18)
    assert sum(info['terms'].values()) == pytest.approx(env.outcome.reward)


def test_sensor_fault_names_channel_step_and_seed(monkeypatch):
    env = HexapodLine('B')
    env.reset(seed=7)
    env.step(np.zeros(30, np.float32))
    monkeypatch.setattr(
        'hexapod_agent.env.read',
        lambda simulation, keys: (
            {'linear_velocity': np.full(3, np.nan)}
            | {key: np.zeros(18) for key in ('joint_angles', 'joint_velocities')}
        ),
    )
    with pytest.raises(
        ObservationError, match=r'linear_velocity\[0\].*step 2 of episode 0, seed 7'
    ):
        env.step(np.zeros(30, np.float32))


def test_torch_stays_out():
    """An environment of a public library pays for no learner of ours."""
    code = (
        'import sys, gymnasium; gymnasium.make("hexapod_agent:HexapodLine-v0"); '
        'sys.exit("torch" in sys.modules)'
    )
    assert subprocess.run([sys.executable, '-c', code], check=False).returncode == 0
