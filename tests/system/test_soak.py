# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Ten thousand episodes through one worker: what it takes at the end is what it took before."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest
import rclpy
from hexapod_doe.bags.verify import verify
from hexapod_interfaces.action import TrainRun
from rclpy.action import ActionClient
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.task import Future

pytestmark = [pytest.mark.system, pytest.mark.slow, pytest.mark.timeout(7200)]
EPISODES = 10_000
BLOCK = 500
STEPS = 10
CONFIG = f"""
task: {{time_limit_steps: {STEPS}}}
ddpg: {{batch_size: 8, buffer_size: 1000, update_every: 5}}
actor: {{hidden: [16, 16]}}
critic: {{hidden: [16, 16]}}
training: {{episodes: {EPISODES}, evaluation: 0, checkpoint_every: 1000}}
observations: ABCDEFG
"""


@dataclass(frozen=True)
class Sample:
    """The worker's process between two episodes."""

    time_s: float
    memory_mb: float
    files: int

    @classmethod
    def of(cls, pid: int) -> Sample:
        status = Path(f'/proc/{pid}/status').read_text()
        resident = next(line for line in status.splitlines() if line.startswith('VmRSS'))
        files = len(list(Path(f'/proc/{pid}/fd').iterdir()))
        return cls(time.monotonic(), int(resident.split()[1]) / 1024.0, files)


class Client:
    """Sends one goal, and looks at the worker after every block of episodes."""

    def __init__(self, pid: int) -> None:
        self.samples: list[Sample] = []
        self._pid = pid
        self.node = Node('soak')
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(self.node)
        self._client = ActionClient(self.node, TrainRun, '/soak/train_run')

    def train(self, goal: TrainRun.Goal) -> TrainRun.Result:
        assert self._client.wait_for_server(30.0)
        handle = self._result(self._client.send_goal_async(goal, self._on_feedback))
        assert handle.accepted
        result = self._result(handle.get_result_async()).result
        # With the last episode the worker was closing bag and checkpoint: look once they are.
        self.samples[-1] = replace(self.samples[-1], files=Sample.of(self._pid).files)
        return result

    def close(self) -> None:
        self._client.destroy()
        self._executor.shutdown()
        self.node.destroy_node()

    def _result(self, future: Future):
        self._executor.spin_until_future_complete(future)
        return future.result()

    def _on_feedback(self, message: TrainRun.Impl.FeedbackMessage) -> None:
        feedback = message.feedback
        if feedback.ended and (feedback.episode + 1) % BLOCK == 0:
            self.samples.append(Sample.of(self._pid))


@pytest.fixture
def client(shell) -> Iterator[Client]:
    rclpy.init()
    worker = shell.start(
        'ros2 run hexapod_bringup worker_node --ros-args -p root:=. -r __ns:=/soak'
    )
    made = Client(worker.pid)
    yield made
    made.close()
    rclpy.shutdown()


def test_ten_thousand_episodes_leave_a_worker_as_it_was(
    client: Client, tmp_path: Path, capsys
) -> None:
    goal = TrainRun.Goal(
        run_id='soak',
        spec=CONFIG,
        seed=1,
        bag=str(tmp_path / 'soak'),
        record_every=1000,
    )
    result = client.train(goal)
    assert (result.message, result.episodes) == ('', EPISODES)
    verify(tmp_path / 'soak')
    memory = np.array([sample.memory_mb for sample in client.samples])
    files = np.array([sample.files for sample in client.samples])
    period_ms = np.diff([sample.time_s for sample in client.samples]) / (BLOCK * STEPS) * 1e3
    with capsys.disabled():
        print(
            f'\nepisodes        {" ".join(f"{n:6d}" for n in range(BLOCK, EPISODES + 1, BLOCK))}'
        )
        print(f'memory, MB      {" ".join(f"{value:6.1f}" for value in memory)}')
        print(f'open files      {" ".join(f"{value:6d}" for value in files)}')
        print(f'period, ms             {" ".join(f"{value:6.2f}" for value in period_ms)}')
    quarter = len(memory) // 4
    assert memory[-quarter:].mean() < 1.05 * memory[quarter : 2 * quarter].mean()
    assert files[len(files) // 2 :].max() <= files[: len(files) // 2].max()
    # Others use the machine as well: the quickest block of each half is compared.
    half = len(period_ms) // 2
    assert period_ms[half:].min() < 1.2 * period_ms[:half].min()
