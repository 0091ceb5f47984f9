# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Where the processor time of a control period goes, in a composed worker that does not learn.

Run: `python tests/benchmarks/bench_parts.py`. The worker runs in this process, with a clock around
each part that stands still while another part's runs. DDS is what is spent outside of all
callbacks, and in publishing: it contains turning messages into bytes and back. Python is the rest:
filling and reading messages, observations, rewards, coroutines. Processor time, for other load
only ever adds to the time on the wall.
"""

from __future__ import annotations

import os
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

# Before rclpy is imported: the nodes of this process are all that there is.
os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'OFF'
os.environ.setdefault('OMP_NUM_THREADS', '1')

import rclpy
from hexapod_agent.learning.training import Trainer
from hexapod_agent.specification.spec_text import changes_text
from hexapod_bringup.worker_node import make_worker
from hexapod_cpg.locomotion import Locomotion
from hexapod_interfaces.action import TrainRun
from hexapod_sim.simulation import Simulation
from rclpy.action import ActionClient
from rclpy.experimental.events_executor import EventsExecutor
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.task import Future
from rich.console import Console
from rich.table import Table

OBSERVATIONS = 'ABCDE'
PERIODS = 600
EPISODES = 5
spent: Counter[str] = Counter()
"""Seconds by part."""
_parts = ['DDS']
_since = 0.0


def switch() -> None:
    """Book the time since the last switch to the part that is under way."""
    global _since
    now = time.process_time()
    spent[_parts[-1]] += now - _since
    _since = now


def timed(part: str, function: Callable[..., Any]) -> Callable[..., Any]:
    """Return the function with a clock around it."""

    def call(*args: Any, **options: Any) -> Any:
        switch()
        _parts.append(part)
        try:
            return function(*args, **options)
        finally:
            switch()
            _parts.pop()

    return call


def watch() -> None:
    """Put clocks around everything that is made from here on."""
    Simulation.advance = timed('physics', Simulation.advance)
    Locomotion.play = timed('pattern generator', Locomotion.play)
    Trainer.observe = timed('actor and noise', Trainer.observe)
    Publisher.publish = timed('DDS', Publisher.publish)
    Future.set_result = timed('Python', Future.set_result)  # resumes coroutines
    subscribe = Node.create_subscription

    def create_subscription(node: Node, kind: type, topic: str, callback: Any, *rest: Any, **more):
        return subscribe(node, kind, topic, timed('Python', callback), *rest, **more)

    Node.create_subscription = create_subscription


class Worker:
    """A composed worker in this process, and a client of it."""

    def __init__(self, config: Path) -> None:
        self._config = str(config)
        self._nodes = [*make_worker(), Node('bench')]
        self._executor = EventsExecutor()
        for node in self._nodes:
            self._executor.add_node(node)
        self._client = ActionClient(self._nodes[-1], TrainRun, 'train_run')

    def train(self, episodes: int) -> None:
        """Have it run some episodes."""
        settings = [f'observations={OBSERVATIONS}', f'training.episodes={episodes}']
        goal = TrainRun.Goal(spec=changes_text(self._config, settings), seed=1)
        handle = self._wait(self._client.send_goal_async(goal))
        response = self._wait(handle.get_result_async())
        assert not response.result.message, response.result.message

    def close(self) -> None:
        """End it."""
        self._executor.shutdown()
        for node in self._nodes:
            node.destroy_node()

    def _wait(self, future: Future) -> Any:
        while not future.done():
            self._executor.spin_once(timeout_sec=0.1)
        return future.result()


def measure(config: Path) -> None:
    """Leave in `spent` a run after a first one that warms the worker up."""
    worker = Worker(config)
    worker.train(1)
    switch()
    spent.clear()
    worker.train(EPISODES)
    switch()
    worker.close()


def main() -> None:
    """Print the table."""
    watch()
    rclpy.init()
    with tempfile.TemporaryDirectory() as directory:
        config = Path(directory) / 'no_learner.yaml'
        config.write_text(
            'ddpg: {batch_size: 100000}\ntraining: {evaluation: 0}\n'
        )  # the buffer never holds a batch
        measure(config)
    rclpy.try_shutdown()
    whole = spent.total()
    parts = ('physics', 'pattern generator', 'actor and noise', 'Python', 'DDS')
    table = Table('part of a control period', 'µs', 'share')
    for name, seconds in [(part, spent[part]) for part in parts] + [('all of it', whole)]:
        table.add_row(
            name, f'{seconds / (EPISODES * PERIODS) * 1e6:.0f}', f'{seconds / whole:.0%}'
        )
    Console().print(table)


if __name__ == '__main__':
    main()
