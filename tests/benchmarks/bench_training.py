# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Share of a training's time that is not the learner, in a composed worker on one core.

By article.yaml, and by swift.yaml, which has an eighth of the updates.

The worker runs in this process, so that its learner can be timed where it is called; the process
is bound to one core, where nothing hides behind anything else. Times are processor time.
"""

from __future__ import annotations

import os

os.environ['OMP_NUM_THREADS'] = '1'

import time
from pathlib import Path

import rclpy
from hexapod_agent.learning.training import Trainer
from hexapod_agent.specification.spec_text import changes_text
from hexapod_bringup.worker_node import make_worker
from hexapod_interfaces.action import TrainRun
from rclpy.action import ActionClient
from rclpy.experimental.events_executor import EventsExecutor
from rclpy.node import Node
from rclpy.task import Future

import hexapod_agent

EPISODES = 4
WARM_UP = 600  # periods; at first the buffer does not hold a batch
OBSERVATIONS = 'ABCDE'
SWIFT = Path(hexapod_agent.__file__).with_name('swift.yaml')


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
    """Train for a few episodes by each specification and print where the time went."""
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    clock = Clock()
    Trainer.learn = clock.around(Trainer.learn)
    rclpy.init()
    executor = EventsExecutor()
    client = Node('bench')
    for node in (*make_worker(), client):
        executor.add_node(node)
    action = ActionClient(client, TrainRun, 'train_run')
    while not action.server_is_ready():
        executor.spin_once(timeout_sec=0.1)
    for name, config in (('article.yaml', None), ('swift.yaml', SWIFT)):
        print(f'{name}: {share(executor, action, clock, config)}')
    rclpy.shutdown()


def share(
    executor: EventsExecutor, action: ActionClient, clock: Clock, config: Path | None
) -> str:
    """Train by a specification and say what a period takes, and the learner of it."""
    clock.calls, clock.seconds = 0, 0.0
    marks: list[tuple[int, float, float]] = []

    def mark(_) -> None:
        if clock.calls >= WARM_UP:
            marks.append((clock.calls, time.process_time(), clock.seconds))

    def result(future: Future):
        while not future.done():
            executor.spin_once(timeout_sec=0.1)
        return future.result()

    settings = [
        f'observations={OBSERVATIONS}', f'training.episodes={EPISODES}', 'training.evaluation=0',
    ]  # fmt: skip
    goal = TrainRun.Goal(run_id='bench', spec=changes_text(config, settings), seed=1)
    handle = result(action.send_goal_async(goal, mark))
    response = result(handle.get_result_async())
    assert response.result.message == '', response.result.message
    periods, total, learner = (
        last - first for first, last in zip(marks[0], marks[-1], strict=True)
    )
    return (
        f'{1e3 * total / periods:.2f} ms a period, {1e3 * learner / periods:.2f} ms the learner; '
        f'{1 - learner / total:.1%} is not the learner'
    )


if __name__ == '__main__':
    main()
