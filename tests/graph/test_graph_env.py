# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""HexapodGraph-v0 is HexapodLine-v0 on live nodes, for learners that know of neither."""

from __future__ import annotations

import time
from collections.abc import Iterator

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from hexapod_agent.environment.evaluation import GraphError
from hexapod_agent.nodes.graph_env import HexapodGraph
from hexapod_agent.specification.run_spec import RunSpec
from stable_baselines3 import SAC

pytestmark = [pytest.mark.graph, pytest.mark.system]
SPEC = RunSpec.from_text(
    'observations: ABCDE\ntask: {time_limit_steps: 30, line_y: 0.1}\n'
    'cpg: {hopf: {alpha: 25.0}}\nsensors: {body_height: {noise: 0.005}}\n',
    'a test',
)


@pytest.fixture(scope='module')
def env() -> Iterator[HexapodGraph]:
    """An environment with a sim and a pattern generator of its own."""
    made = HexapodGraph(config=SPEC)
    yield made
    processes = made.robot.processes.values()
    made.close()
    assert [process.returncode for process in processes] == [0, 0]


def walk(env: gymnasium.Env, seed: int, episodes: int = 2) -> list[object]:
    """Return all that episodes show: their starts, steps and ends."""
    generator, shown = np.random.default_rng(seed), []
    for episode in range(episodes):
        observation, info = env.reset(seed=None if episode else seed)
        over = False
        shown.append((observation.tolist(), info['terms'], info['cause']))
        while not over:
            action = generator.uniform(-0.5, 0.5, 30).astype(np.float32)
            observation, reward, terminated, truncated, info = env.step(action)
            over = terminated or truncated
            shown.append((observation.tolist(), reward, terminated, truncated, info['terms'],
                          info['cause']))  # fmt: skip
    return shown


def test_it_equals_the_environment_to_the_last_bit(env) -> None:
    line = gymnasium.make('hexapod_agent:HexapodLine-v0', config=SPEC)
    expected = walk(line, 5)
    assert len(expected) > 30
    assert walk(env, 5) == expected
    # Somebody else on the same nodes, as those of a running worker.
    guest = HexapodGraph(namespace=env.robot.namespace, config=SPEC)
    try:
        assert guest.robot is None
        assert walk(guest, 5) == expected
    finally:
        guest.close()
    assert (env.observation_space, env.action_space) == (
        line.observation_space, line.action_space,
    )  # fmt: skip


@pytest.mark.filterwarnings('ignore:.*not have a `spec`:UserWarning')
def test_it_is_what_gymnasium_expects(env) -> None:
    check_env(env, skip_render_check=True, skip_close_check=True)
    env.reset(seed=1)
    _, _, _, truncated, _ = [env.step(np.zeros(30, np.float32)) for _ in range(30)][-1]
    assert truncated
    with pytest.raises(GraphError, match='no episode is under way, expected reset'):
        env.step(np.zeros(30, np.float32))


def test_sac_of_a_public_library_trains_on_it(env) -> None:
    learn(env, 70)


def learn(env: gymnasium.Env, steps: int) -> None:
    """Let a public library's SAC train."""
    model = SAC(
        'MlpPolicy', env, learning_starts=32, batch_size=32, buffer_size=2000, seed=1,
        policy_kwargs={'net_arch': [32, 32]}, device='cpu',
    )  # fmt: skip
    before = [parameter.detach().clone() for parameter in model.actor.parameters()]
    model.learn(steps)
    assert model.num_timesteps == steps
    after = model.actor.parameters()
    assert any(not np.array_equal(a, b.detach()) for a, b in zip(before, after, strict=True))


@pytest.mark.slow
def test_sac_of_a_public_library_trains_for_a_thousand_steps() -> None:
    env = gymnasium.make('hexapod_agent:HexapodGraph-v0', observations='ABCDE')
    try:
        learn(env, 1000)
    finally:
        env.close()


@pytest.mark.parametrize('killed', ['sim', 'cpg'])
def test_a_killed_node_ends_a_step_with_one_error(killed: str) -> None:
    env = HexapodGraph(config=SPEC)
    guest = HexapodGraph(namespace=env.robot.namespace, config=SPEC)
    other = env.robot.processes['cpg' if killed == 'sim' else 'sim']
    try:
        guest.reset(seed=1)
        guest._client._loop._lock_step._timeout_s = 1.5  # a busy machine began in more
        env.robot.processes[killed].kill()
        began = time.monotonic()
        with pytest.raises(GraphError, match=r'no sample of .* within 1.5 s: expected one'):
            guest.step(np.zeros(30, np.float32))
        assert 1.0 < time.monotonic() - began < 20.0
        with pytest.raises(GraphError, match=rf'/{killed} ended with status -9, expected it'):
            env.reset(seed=1)
    finally:
        guest.close()
        env.close()
    assert other.returncode == 0
    with pytest.raises(GraphError, match='is closed'):
        env.reset()


def test_without_nodes_it_says_so() -> None:
    with pytest.raises(GraphError, match=r'/nobody/sim/set_parameters_atomically: no answer'):
        HexapodGraph(namespace='/nobody', config=SPEC, timeout=1.5)
