# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Environment, fleet, composed worker and separate processes: the same numbers to the last bit."""

from __future__ import annotations

import os
import signal
import subprocess
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

import gymnasium
import numpy as np
import pytest
from hexapod_agent.environment.env import HexapodLine
from hexapod_agent.fleet.robots import Robots
from hexapod_agent.learning.training import Trainer
from hexapod_agent.nodes.agent_node import AgentNode
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_agent.train import evaluate
from hexapod_cpg.nodes.cpg_node import CpgNode
from hexapod_interfaces.action import TrainRun
from hexapod_sim.nodes.sim_node import SimNode
from hexapod_sim.sensor_table import LETTERS
from hexapod_sim.task import episode_seed
from trajectory_msgs.msg import JointTrajectory

pytestmark = pytest.mark.graph
SEED = 11
STEPS = 300
PERFECT = f"""
observations: {LETTERS}
task: {{time_limit_steps: {STEPS}}}
training: {{episodes: 1, evaluation: 1}}
"""
BAD = """
sensors:
  joint_states: {noise: 0.02, rate: 30.0}
  line_offset: {bias: 0.1, dropout: 0.2}
  imu_data: {noise: 0.05, bias: 0.1, delay: 0.06, dropout: 0.3, quantisation: 0.01, rate: 20.0}
  body_height: {noise: 0.005}
  foot_force: {noise: 1.0, dropout: 0.3}
  foot_contacts: {noise: 0.1, delay: 0.025}
"""

# One row after the other on the same live nodes, so that each reset has to be clean as well.
ROWS = {
    'rough': 'scene: {name: rough, run_up: 0.3}',
    'stairs': 'scene: {name: stairs, run_up: 0.3}',
    'slope': 'scene: {name: slope, run_up: 0.3, gradient: 0.4}',
    'slippery': 'scene: {friction: 0.4}',
    'payload': 'robot: {payload: 1.2, payload_x: 0.05}',
    'dead leg': 'robot: {dead_legs: lf}',
    'missing leg': 'robot: {missing_legs: rm}',
    'blocked joint': 'robot: {blocked_joints: lf_knee, blocked_angle: 0.8}',
    'weak motors': 'robot: {motor_strength: 0.7}',
    'faults on the way': """
robot: {payload: 0.6, dead_legs: lf, missing_legs: rm, blocked_joints: lr_hip, motor_strength: 0.9,
        fault_time: 0.5}""",
    'flat and sound': '',
}
ROW_STEPS = 70
"""In which a walk comes to lie on the ground of its scene."""


def row(name: str) -> str:
    """Return the specification of a short run."""
    return f"""
observations: {LETTERS}
{ROWS[name]}
task: {{time_limit_steps: {ROW_STEPS}, start_offset: 0.1}}
training: {{episodes: 1, evaluation: 1}}
"""


def planned_actions() -> np.ndarray:
    """Return actions that use the whole range, changing slowly enough to walk."""
    generator = np.random.default_rng(5)
    corners = generator.uniform(-1.0, 1.0, (STEPS // 20 + 2, 30))
    steps = np.arange(STEPS) / 20
    columns = [np.interp(steps, np.arange(len(corners)), column) for column in corners.T]
    return np.array(columns, dtype=np.float32).T


class ScriptedTrainer(Trainer):
    """Plays the planned actions and keeps what it is shown."""

    def __init__(self, *args) -> None:
        super().__init__(*args)
        self.actions = planned_actions()
        self.observations: list[np.ndarray] = []
        self.rewards: list[float] = []

    def observe(self, observation, outcome):
        super().observe(observation, outcome)
        self._keep(observation, outcome)
        self._action = self.actions[outcome.step]
        return self._action

    def end_episode(self, observation, outcome):
        self._keep(observation, outcome)
        return super().end_episode(observation, outcome)

    def learn(self) -> None:
        """Learn nothing."""

    def _keep(self, observation, outcome) -> None:
        self.observations.append(observation.copy())
        self.rewards.append(outcome.reward)


class Tape:
    """What one path produced."""

    def __init__(self, spec: str, observations, rewards, targets, evaluation: float) -> None:
        self.spec, self.evaluation = spec, evaluation
        self.observations = np.array(observations)
        self.rewards = np.array(rewards)
        self.targets = np.array(targets)

    def assert_equal(self, other: Tape) -> None:
        np.testing.assert_array_equal(self.rewards, other.rewards)
        np.testing.assert_array_equal(self.observations, other.observations)
        np.testing.assert_array_equal(self.targets, other.targets)
        assert self.evaluation == other.evaluation


def assert_same(tapes: Sequence[Tape], others: Sequence[Tape]) -> None:
    for tape, other in zip(tapes, others, strict=True):
        tape.assert_equal(other)


def in_environment(text: str) -> Tape:
    """Play the actions in the Gymnasium environment."""
    spec = RunSpec.from_text(text, 'a test')
    env = gymnasium.make('hexapod_agent:HexapodLine-v0', config=spec)
    observation, _ = env.reset(seed=SEED)
    observations, rewards, targets = [observation], [0.0], []
    for action in planned_actions():
        observation, reward, terminated, truncated, info = env.step(action)
        observations.append(observation)
        rewards.append(reward)
        targets.append(info['joint_targets'])
        if terminated or truncated:
            break
    enough = min(STEPS // 4, spec.task.time_limit_steps - 1)
    assert len(targets) > enough, 'the planned actions end the episode too early'
    *_, judged = evaluate(HexapodLine(config=spec), Trainer(spec, SEED))
    return Tape(text, observations, rewards, targets, judged.average_return)


def in_fleet(texts: Sequence[str]) -> list[Tape]:
    """Play the actions on robots side by side, the evaluation left out."""
    specs = [RunSpec.from_text(text, 'a test') for text in texts]
    robots = Robots(len(specs))
    tapes: list[tuple[list, list]] = [([], []) for _ in specs]

    def keep(slot: int, observation, outcome) -> None:
        tapes[slot][0].append(observation)
        tapes[slot][1].append(outcome.reward)

    for slot, spec in enumerate(specs):
        keep(slot, *robots.reset(slot, spec, episode_seed(SEED, 0)))
    for action in planned_actions()[:ROW_STEPS]:
        robots.actions[:] = action
        robots.command()
        for slot, spec in enumerate(specs):
            outcome = robots.advance(slot)
            keep(slot, robots.observe(slot, spec.observed), outcome)
    return [Tape(text, *tape, (), 0.0) for text, tape in zip(texts, tapes, strict=True)]


@pytest.fixture(scope='module', params=[PERFECT, PERFECT + BAD], ids=['perfect', 'bad'])
def reference(request) -> Tape:
    """Play with perfect sensors or bad ones."""
    return in_environment(request.param)


@pytest.fixture(scope='module')
def rows() -> list[Tape]:
    """Play a run in each world."""
    return [in_environment(row(name)) for name in ROWS]


def play_on_graph(graph, *specs: str) -> list[Tape]:
    """Play the actions through an agent node; sim and pattern generator are there already."""
    trainers: list[ScriptedTrainer] = []
    targets: list[list[list[float]]] = []

    def make_trainer(*args) -> ScriptedTrainer:
        trainers.append(ScriptedTrainer(*args))
        return trainers[-1]

    def keep(message: JointTrajectory) -> None:
        targets.append([list(point.positions) for point in message.points])

    graph.nodes[0].create_subscription(JointTrajectory, 'joint_trajectory', keep, 1000)
    publishers = graph.nodes[0].count_publishers
    graph.add(AgentNode(make_trainer))
    graph.until(lambda: publishers('joint_trajectory') == 1)
    tapes = []
    for spec in specs:
        targets.clear()
        response = graph.train(TrainRun.Goal(run_id='one_path', spec=spec, seed=SEED))
        assert response.result.message == ''
        trainer = trainers[-1]
        periods = len(trainer.rewards) - 1
        graph.until(lambda least=periods: len(targets) > least)  # those of the evaluation follow
        judged = response.result.evaluation_return
        tapes.append(Tape(spec, trainer.observations, trainer.rewards, targets[:periods], judged))
    return tapes


@contextmanager
def process(*command: str) -> Iterator[subprocess.Popen]:
    """Run a node as a process of its own, and check that SIGINT ends it well."""
    running = subprocess.Popen(command, env=os.environ)
    try:
        yield running
    finally:
        running.send_signal(signal.SIGINT)
        assert running.wait(10.0) == 0


def test_composed_worker_equals_environment(graph, reference: Tape) -> None:
    graph.add(SimNode(), CpgNode())
    (tape,) = play_on_graph(graph, reference.spec)
    tape.assert_equal(reference)


def test_each_row_is_another_run(rows: list[Tape]) -> None:
    assert len({tape.rewards.tobytes() for tape in rows}) == len(rows)


def test_rows_of_a_fleet_equal_the_environment(rows: list[Tape]) -> None:
    for tape, alone in zip(in_fleet([tape.spec for tape in rows]), rows, strict=True):
        np.testing.assert_array_equal(tape.observations, alone.observations)
        np.testing.assert_array_equal(tape.rewards, alone.rewards)


def test_rows_on_a_composed_worker_equal_the_environment(graph, rows: list[Tape]) -> None:
    graph.add(SimNode(), CpgNode())
    assert_same(play_on_graph(graph, *(tape.spec for tape in rows)), rows)


@pytest.mark.system
@pytest.mark.parametrize('step', [5, pytest.param(1, marks=pytest.mark.slow)])
def test_rows_on_separate_processes_equal_the_environment(
    graph, rows: list[Tape], step: int
) -> None:
    rows = rows[::step]
    with (
        process('ros2', 'run', 'hexapod_sim', 'sim_node'),
        process('ros2', 'run', 'hexapod_cpg', 'cpg_node'),
    ):
        assert_same(play_on_graph(graph, *(tape.spec for tape in rows)), rows)


@pytest.mark.system
def test_separate_processes_equal_environment(graph, reference: Tape) -> None:
    with (
        process('ros2', 'run', 'hexapod_sim', 'sim_node'),
        process('ros2', 'run', 'hexapod_cpg', 'cpg_node'),
    ):
        (tape,) = play_on_graph(graph, reference.spec)
        tape.assert_equal(reference)
