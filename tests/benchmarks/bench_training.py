# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Share of a training's time that is not the learner, in a composed worker on one core.

The worker runs in this process, so that its learner can be timed where it is called; the process
is bound to one core, where nothing hides behind anything else. Times are processor time.
"""

from __future__ import annotations

import os

os.environ['OMP_NUM_THREADS'] = '1'

import time

import rclpy
from hexapod_agent.learning.training import Trainer
from hexapod_bringup.worker_node import make_worker
from hexapod_interfaces.action import TrainRun
from rclpy.action import ActionClient
from rclpy.experimental.events_executor import EventsExecutor
from rclpy.node import Node
from rclpy.task import Future

EPISODES = 4
WARM_UP = 600  # periods; at first the buffer does not hold a batch
OBSERVATIONS = 'ABCDE'


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


def main() -> None:
    """Train for a few episodes and print where the time went."""
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    clock = Clock()
    Trainer.learn = clock.around(Trainer.learn)
    rclpy.init()
    executor = EventsExecutor()
    client = Node('bench')
    for node in (*make_worker(), client):
        executor.add_node(node)

    def result(future: Future):
        while not future.done():
            executor.spin_once(timeout_sec=0.1)
        return future.result()

    action = ActionClient(client, TrainRun, 'train_run')
    while not action.server_is_ready():
        executor.spin_once(timeout_sec=0.1)
    marks: list[tuple[int, float, float]] = []

    def mark(_) -> None:
        if clock.calls >= WARM_UP:
            marks.append((clock.calls, time.process_time(), clock.seconds))

    spec = f'{{observations: {OBSERVATIONS}, training: {{episodes: {EPISODES}, evaluation: 0}}}}'
    goal = TrainRun.Goal(run_id='bench', spec=spec, seed=1)
    handle = result(action.send_goal_async(goal, mark))
    response = result(handle.get_result_async())
    assert response.result.message == '', response.result.message
    periods, total, learner = (
        last - first for first, last in zip(marks[0], marks[-1], strict=True)
    )
    print(f'{1e3 * total / periods:.2f} ms a period, {1e3 * learner / periods:.2f} ms the learner')
    print(f'share of the time that is not the learner: {1 - learner / total:.1%} (target 15 %)')
    rclpy.shutdown()


if __name__ == '__main__':
    main()
