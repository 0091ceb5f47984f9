# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Node `case`: has one row trained by the worker that it shares its process with."""

import os
import signal
from functools import partial
from pathlib import Path

from hexapod_agent.nodes.action_names import TRAIN_RUN
from hexapod_agent.nodes.agent_node import AgentNode
from hexapod_cpg.nodes.cpg_node import CpgNode
from hexapod_interfaces.action import TrainRun
from hexapod_node.actions import ActionClient
from hexapod_node.coroutines import start, until_true
from hexapod_node.node import Node
from hexapod_node.root import root_arguments
from hexapod_node.shared_memory import free_abandoned
from hexapod_node.spin import run
from hexapod_sim.nodes.sim_node import SimNode
from rclpy.signals import uninstall_signal_handlers
from rclpy.task import Future

from hexapod_doe.campaigns.row import Row
from hexapod_doe.nodes.recorder_node import RecorderNode
from hexapod_doe.nodes.train_goal import train_goal
from hexapod_doe.nodes.worker_client import WorkerClient, WorkerLostError

_READY_S = 10.0
_LOG_S = 10.0


class CaseNode(Node):
    """Sends its one goal, follows it, and ends the process with what became of it.

    Attributes:
        exit_status: 0 once the row is trained, 1 once it has failed or was stopped, None before.
    """

    def __init__(self, row: Row, record_every: int, stall_s: float) -> None:
        super().__init__('case')
        self.exit_status: int | None = None
        self._row, self._record_every = row, record_every
        client = ActionClient(self, TrainRun, TRAIN_RUN)
        self._worker = WorkerClient(self, client, self.get_namespace(), stall_s)
        start(self._train()).add_done_callback(self._on_end)

    async def _train(self) -> str:
        """Return why it failed, or ''."""
        if not await until_true(self, self._worker.present, _READY_S):
            return f'no worker within {_READY_S:g} s, expected the one of this process'
        try:
            goal = train_goal(self._row, self._record_every)
            ended = await self._worker.train(goal, self._on_episode)
        except WorkerLostError as error:
            return str(error)
        return ended.message

    def stop(self) -> None:
        """End the process in order; what the row has so far stays."""
        self.exit_status = 1

    def _on_episode(self, episode: int, episode_return: float) -> None:
        self.get_logger().info(
            f'{self._row.run_id}: episode {episode + 1} of '
            f'{self._row.spec.training.episodes}, return {episode_return:.1f}',
            throttle_duration_sec=_LOG_S,
        )

    def _on_end(self, ended: Future) -> None:
        reason = ended.result()
        if reason:
            self.get_logger().error(f'{self._row.run_id}: {reason}')
        self.exit_status = 1 if reason else 0


def train_row(row: Row, record_every: int, stall_s: float) -> None:
    """Train a row on a worker that nobody outside this process can see.

    Raises:
        SystemExit: always, at the end of the training or after a signal.
    """
    # Nodes of one process find each other all the same.
    os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'OFF'
    free_abandoned()
    namespace = ['--ros-args', '-r', f'__ns:=/{row.run_id}']
    files = root_arguments(Path(row.bag).resolve().parent)
    run(partial(_make_nodes, row, record_every, stall_s), [*namespace, *files])


def _make_nodes(row: Row, record_every: int, stall_s: float) -> list[Node]:
    worker: list[Node] = [SimNode(), CpgNode(), RecorderNode(), AgentNode()]
    case = CaseNode(row, record_every, stall_s)
    # The middleware's own handlers would end it under the feet of a worker at work.
    uninstall_signal_handlers()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: case.stop())
    return [*worker, case]
