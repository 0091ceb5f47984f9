# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What a control period of a training takes: physics, learner and all else, on one core.

By article.yaml, and by swift.yaml, which has an eighth of the updates; in a composed worker and in
the environment. The worker runs in this process, so that physics and learner can be timed where
they are called; the process is bound to one core, where nothing hides behind anything else. Times
are processor time, of the episode in which a period took least: other load only ever adds.
"""

from __future__ import annotations

import operator
import os

os.environ['OMP_NUM_THREADS'] = '1'

import time
from pathlib import Path

import rclpy
from hexapod_agent.environment.env import HexapodLine
from hexapod_agent.learning.training import Trainer
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_agent.specification.spec_text import changes_text
from hexapod_agent.train import train_episode
from hexapod_bringup.worker_node import make_worker
from hexapod_interfaces.action import TrainRun
from hexapod_sim.simulation import Simulation
from rclpy.action import ActionClient
from rclpy.experimental.events_executor import EventsExecutor
from rclpy.node import Node
from rclpy.task import Future
from rich.console import Console
from rich.table import Table

import hexapod_agent

EPISODES = 5  # the first is a warm-up: at its begin the buffer does not hold a batch
OBSERVATIONS = 'ABCDE'
SWIFT = Path(hexapod_agent.__file__).with_name('swift.yaml')
CONFIGS = {'article.yaml': None, 'swift.yaml': SWIFT}


class Clock:
    """Adds up the time of a method's calls."""

    def __init__(self) -> None:
        self.seconds = 0.0
        self.calls = 0

    def around(self, method):
        """Return the method with its calls timed."""

        def timed(*args):
            began = time.process_time()
            try:
                return method(*args)
            finally:
                self.seconds += time.process_time() - began
                self.calls += 1

        return timed


PHYSICS, LEARNER = Clock(), Clock()


class Periods:
    """Time of the control periods, by episode.

    Attributes:
        rows: Milliseconds of a period, of the physics and of the learner in it (episodes, 3).
    """

    def __init__(self) -> None:
        self.rows: list[list[float]] = []
        self._before = self._now()

    def _now(self) -> tuple[float, ...]:
        return LEARNER.calls, time.process_time(), PHYSICS.seconds, LEARNER.seconds

    def end_episode(self) -> None:
        """Take in the periods since the last call."""
        now = self._now()
        periods, *seconds = map(operator.sub, now, self._before)
        if periods:
            self.rows.append([1e3 * each / periods for each in seconds])
            self._before = now

    def best(self) -> list[float]:
        """Return the row of the episode in which a period took least, the first apart."""
        return min(self.rows[1:])


class Worker:
    """A composed worker in this process, and a client of it."""

    def __init__(self) -> None:
        self._executor = EventsExecutor()
        client = Node('bench')
        for node in (*make_worker(), client):
            self._executor.add_node(node)
        self._action = ActionClient(client, TrainRun, 'train_run')
        while not self._action.server_is_ready():
            self._executor.spin_once(timeout_sec=0.1)

    def train(self, config: Path | None) -> Periods:
        """Train for a few episodes by a specification."""
        periods = Periods()

        def heard(message) -> None:
            if message.feedback.ended:
                periods.end_episode()

        settings = [
            f'observations={OBSERVATIONS}', f'training.episodes={EPISODES}',
            'training.evaluation=0',
        ]  # fmt: skip
        goal = TrainRun.Goal(run_id='bench', spec=changes_text(config, settings), seed=1)
        handle = self._result(self._action.send_goal_async(goal, heard))
        response = self._result(handle.get_result_async())
        assert response.result.message == '', response.result.message
        return periods

    def _result(self, future: Future):
        while not future.done():
            self._executor.spin_once(timeout_sec=0.1)
        return future.result()


def in_environment(config: Path | None) -> Periods:
    """Train for a few episodes in the environment."""
    spec = RunSpec.load(config).observing(OBSERVATIONS)
    env, trainer = HexapodLine(config=spec), Trainer(spec, 1)
    periods = Periods()
    for _ in range(EPISODES):
        train_episode(env, trainer)
        periods.end_episode()
    return periods


def main() -> None:
    """Print the table."""
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    Trainer.learn = LEARNER.around(Trainer.learn)
    Simulation.advance = PHYSICS.around(Simulation.advance)
    rclpy.init()
    paths = {'composed worker': Worker().train, 'environment': in_environment}
    table = Table('one control period of', 'ms', 'physics', 'learner', 'all else')
    for name, config in CONFIGS.items():
        for path, train in paths.items():
            total, *parts = train(config).best()
            shares = [each / total for each in (*parts, total - sum(parts))]
            table.add_row(f'{name}, {path}', f'{total:.3f}', *map('{:.1%}'.format, shares))
    Console().print(table)
    rclpy.shutdown()


if __name__ == '__main__':
    main()
