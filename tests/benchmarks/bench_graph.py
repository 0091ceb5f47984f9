# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Control periods per second without a learner, in the environments and of workers.

Of the Gymnasium environment, a composed worker, a worker of four processes, and the Gymnasium
environment that drives the nodes sim and cpg as processes.
"""

from __future__ import annotations

import math
import os
import shlex
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import rclpy
from hexapod_agent.environment.env import HexapodLine
from hexapod_agent.nodes.graph_env import HexapodGraph
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_agent.specification.spec_text import changes_text
from hexapod_cpg.mapping import ACTION_SIZE
from hexapod_interfaces.action import TrainRun
from rclpy.action import ActionClient
from rclpy.experimental.events_executor import EventsExecutor
from rclpy.node import Node
from rclpy.task import Future

EPISODES = 4
ANSWER_S = 15.0  # an episode takes one or two
OBSERVATIONS = 'ABCDE'
# The buffer never holds a batch, so nothing is learned.
NO_LEARNER = 'ddpg: {batch_size: 100000}\ntraining: {evaluation: 0}\n'
TARGETS = {
    'environment': 4000, 'composed worker': 2000, 'four processes': 700, 'HexapodGraph-v0': 700,
}  # fmt: skip
"""Periods per second that two idle cores are to reach."""


def environment(env: HexapodLine | HexapodGraph) -> float:
    """Return periods per second of an environment, its first episode apart."""
    env.reset(seed=1)
    action = np.zeros(ACTION_SIZE, dtype=np.float32)
    periods = 0
    began = time.perf_counter()
    for episode in range(EPISODES):
        env.reset(seed=1, options={'episode': episode})
        ended = False
        while not ended:
            _, _, terminated, truncated, _ = env.step(action)
            ended = terminated or truncated
            periods += 1
    rate = periods / (time.perf_counter() - began)
    env.close()
    return rate


class Client:
    """Sends runs to a worker."""

    def __init__(self) -> None:
        rclpy.init()
        self.executor = EventsExecutor()
        self.node = Node('bench')
        self.executor.add_node(self.node)

    def result(self, future: Future, limit_s: float = math.inf):
        """Spin until a future is done; return None if it is not within a limit."""
        deadline = time.monotonic() + limit_s
        while not future.done():
            if time.monotonic() > deadline:
                return None
            self.executor.spin_once(timeout_sec=0.1)
        return future.result()

    def warm_up(self, client: ActionClient, goal: TrainRun.Goal) -> None:
        """Have a worker do a run, and once more until its answers arrive.

        A server that has just appeared may not know yet where this client listens.
        """
        while not client.server_is_ready():
            self.executor.spin_once(timeout_sec=0.1)
        while True:
            handle = self.result(client.send_goal_async(goal), ANSWER_S)
            if handle and handle.accepted and self.result(handle.get_result_async(), ANSWER_S):
                return

    def worker(self, namespace: str, config: Path) -> float:
        """Return periods per second of a worker's second run; the first one warms it up."""
        client = ActionClient(self.node, TrainRun, f'/{namespace}/train_run')
        settings = [f'observations={OBSERVATIONS}', 'training.episodes=1']
        goal = TrainRun.Goal(run_id='bench', spec=changes_text(config, settings), seed=1)
        self.warm_up(client, goal)
        goal.spec = changes_text(config, [settings[0], f'training.episodes={EPISODES}'])
        began = time.perf_counter()
        handle = self.result(client.send_goal_async(goal))
        response = self.result(handle.get_result_async())
        assert response.result.message == '', response.result.message
        return EPISODES * 600 / (time.perf_counter() - began)


def launched(client: Client, config: Path, namespace: str, composed: str) -> float:
    """Launch a worker, measure it, end it."""
    command = (
        f'ros2 launch hexapod_bringup worker.launch.xml namespace:={namespace} '
        f'composed:={composed}'
    )
    process = subprocess.Popen(shlex.split(command), stdout=subprocess.DEVNULL)
    try:
        return client.worker(namespace, config)
    finally:
        process.send_signal(signal.SIGINT)
        process.wait(15.0)


def main() -> None:
    """Print the three rates and their ratios."""
    os.environ.setdefault('OMP_NUM_THREADS', '1')
    with tempfile.TemporaryDirectory() as directory:
        config = Path(directory) / 'no_learner.yaml'
        config.write_text(NO_LEARNER)
        client = Client()
        rates = {
            'environment': environment(HexapodLine(OBSERVATIONS, RunSpec.load())),
            'composed worker': launched(client, config, 'composed', 'true'),
            'four processes': launched(client, config, 'separate', 'false'),
            'HexapodGraph-v0': environment(HexapodGraph(OBSERVATIONS)),
        }
    for name, rate in rates.items():
        share = rate / rates['environment']
        print(
            f'{name:16} {rate:8.0f} periods/s  {share:5.2f} of the environment  '
            f'(target {TARGETS[name]})'
        )
    rclpy.shutdown()


if __name__ == '__main__':
    sys.exit(main())
