# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The environment is what Gymnasium expects, repeatable, and free of torch."""

import copy
import pickle
import subprocess
import sys
import warnings

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import AsyncVectorEnv, AutoresetMode, SyncVectorEnv
from hexapod_agent.environment.env import HexapodLine
from hexapod_agent.specification.observation import ObservationError
from hexapod_cpg.mapping import READINGS
from hexapod_sim.sensor_table import CHANNELS, LETTERS
from hexapod_sim.task import episode_seed
from hexapod_sim.viewer import ViewerError

from hexapod_sim import sensors

ID = 'hexapod_agent:HexapodLine-v0'


def test_tables_of_the_docstring_are_those_of_the_code():
    """Counts, scales and units of the observation, value and half width of the actions."""
    rows = [line.strip().strip('|').split('|') for line in HexapodLine.__doc__.splitlines()]
    cells = [[cell.strip() for cell in row] for row in rows if len(row) == 5]
    letters = ('always', *LETTERS)
    told = [(row[0].replace('always', ''), *row[2:]) for row in cells if row[0] in letters]
    table = [
        (channel.letter, str(each.size), f'{each.scale:g}', each.unit)
        for channel in CHANNELS
        for each in channel.quantities
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


@pytest.fixture(autouse=True)
def no_window(monkeypatch):
    for name in ('DISPLAY', 'WAYLAND_DISPLAY'):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setitem(HexapodLine.metadata, 'render_modes', ['rgb_array'])


@pytest.mark.parametrize(
    ('observations', 'render_mode'),
    [('', None), ('ABCDE', 'rgb_array'), ('ABCDEFG', None)],
)
def test_check_env_has_no_complaint(observations, render_mode):
    with warnings.catch_warnings():
        warnings.simplefilter('error')
        env = gymnasium.make(
            ID, observations=observations, render_mode=render_mode, width=64, height=48
        )
        check_env(env.unwrapped)


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
    read = sensors.read
    broken = {'linear_velocity': np.full(3, np.nan)}
    monkeypatch.setattr(sensors, 'read', lambda robot, keys: read(robot, keys) | broken)
    with pytest.raises(
        ObservationError, match=r'linear_velocity\[0\].*step 2 of episode 0, seed 7'
    ):
        env.step(np.zeros(30, np.float32))


def by_pickle(env):
    return pickle.loads(pickle.dumps(env))


@pytest.mark.parametrize('duplicate', [copy.deepcopy, by_pickle])
@pytest.mark.parametrize('steps', [None, 0, 25, 40])
def test_a_copy_goes_on_as_the_original(small_config, duplicate, steps):
    """Before the first episode, at the start of one, in the middle and at the end."""
    env = HexapodLine('ABCDEFG', small_config)
    if steps is not None:
        env.reset(seed=3)
        walk(env, steps)
    twin = duplicate(env)
    assert twin.outcome == env.outcome
    if steps is None:
        assert np.array_equal(env.reset(seed=3)[0], twin.reset(seed=3)[0])
    # One after the other: what the original does must not move the copy.
    left = 40 - (steps or 0)
    assert_same_walk(walk(env, left), walk(twin, left))
    assert np.array_equal(env.reset()[0], twin.reset()[0])
    assert_same_walk(walk(env, 40), walk(twin, 40))


def assert_same_walk(first, second):
    np.testing.assert_array_equal(first[0], second[0])
    assert first[1] == second[1]


@pytest.mark.parametrize('kind', [SyncVectorEnv, AsyncVectorEnv])
@pytest.mark.parametrize('mode', [AutoresetMode.NEXT_STEP, AutoresetMode.SAME_STEP])
def test_robots_of_a_vector_begin_anew_one_by_one(kind, mode):
    def make(limit: int):
        return lambda: gymnasium.make(ID, observations='E', max_episode_steps=limit)

    robots = kind([make(3), make(600)], autoreset_mode=mode)
    alone = HexapodLine('E')
    robots.reset(seed=1)
    alone.reset(seed=2)  # a vector seeds its robots one after the other
    truncated = []
    for _ in range(7):
        observations, rewards, _, ends, info = robots.step(np.zeros((2, 30), np.float32))
        observation, reward, *_ = alone.step(np.zeros(30, np.float32))
        np.testing.assert_array_equal(observations[1], observation)
        assert rewards[1] == reward
        truncated.append(bool(ends[0]))
    assert info['joint_targets'].shape == (2, 5, 18)
    period = 3 if mode is AutoresetMode.SAME_STEP else 4
    assert truncated == [step % period == 2 for step in range(7)]
    robots.close()


def test_pictures_show_the_robot():
    env = HexapodLine(render_mode='rgb_array', width=64, height=48, camera='top')
    env.reset(seed=1)
    first = env.render()
    assert (first.shape, first.dtype) == ((48, 64, 3), np.uint8)
    assert first.std() > 10.0  # something is to be seen
    walk(env, 20)
    assert not np.array_equal(env.render(), first)
    env.close()
    env.close()


def test_a_copy_draws_for_itself():
    env = HexapodLine(render_mode='rgb_array', width=64, height=48)
    env.reset(seed=1)
    seen = env.render().astype(int)
    twin = copy.deepcopy(env)
    env.close()
    # Edges may be drawn otherwise in another surface.
    assert np.abs(twin.render().astype(int) - seen).mean() < 1.0
    twin.close()


def test_frames_are_collected_by_gymnasium():
    env = gymnasium.make(ID, render_mode='rgb_array_list', width=64, height=48)
    env.reset(seed=1)
    env.step(np.zeros(30, np.float32))
    assert [frame.shape for frame in env.render()] == [(48, 64, 3)] * 2
    env.close()


def test_without_a_render_mode_nothing_is_drawn():
    env = HexapodLine()
    env.reset(seed=1)
    with pytest.warns(UserWarning, match='made without render_mode'):
        assert env.render() is None


def test_a_window_without_a_display_is_one_clear_error():
    with pytest.raises(ViewerError, match='no display'):
        HexapodLine(render_mode='human').reset(seed=1)


@pytest.mark.parametrize(
    ('arguments', 'message'),
    [
        ({'render_mode': 'ansi'}, "render_mode 'ansi': expected None, 'rgb_array' or 'human'"),
        ({'camera': 'left'}, "camera 'left': expected one of track, top"),
        ({'width': 5000}, 'picture of 5000 x 320: expected 1 x 1 to 1280 x 720'),
    ],
)
def test_what_cannot_be_drawn_is_refused(arguments, message):
    with pytest.raises(ValueError, match=message):
        HexapodLine(**arguments)


def test_torch_stays_out():
    """An environment of a public library pays for no learner of ours."""
    code = (
        'import sys, gymnasium; gymnasium.make("hexapod_agent:HexapodLine-v0"); '
        'sys.exit("torch" in sys.modules)'
    )
    assert subprocess.run([sys.executable, '-c', code], check=False).returncode == 0
