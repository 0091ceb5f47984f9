# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Node `manager`: runs a plan on every worker that it discovers."""

from __future__ import annotations

import os
import time
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

from action_msgs.msg import GoalStatus
from diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from hexapod_interfaces.action import TrainRun
from hexapod_interfaces.msg import CampaignStatus
from hexapod_node.coroutines import sleep, start, until
from hexapod_node.diagnostics import Diagnostics, Health
from hexapod_node.parameters import Parameter, declare
from hexapod_node.qos import LATCHED
from hexapod_node.spin import run
from rclpy.action import ActionClient, get_action_names_and_types
from rclpy.node import Node
from rclpy.task import Future

from hexapod_doe.campaigns.campaign import Campaign, Row
from hexapod_doe.campaigns.dashboard import Dashboard
from hexapod_doe.campaigns.local_workers import LocalWorkers
from hexapod_doe.campaigns.page_writer import PageWriter

_ACTION = 'hexapod_interfaces/action/TrainRun'
_TICK_S = 0.2
_LOST_S = 5.0
_BUSY_S = 2.0

PARAMETERS = (
    Parameter('plan', '', 'plan.csv of the campaign; its bags lie beside it, under runs/'),
    Parameter('episodes', 1000, 'episodes of a training', range=(1, 1_000_000)),
    Parameter('config', '', 'hyper-parameter file on the workers; empty: article.yaml'),
    Parameter(
        'record_every',
        100,
        'every how many episodes all topics are recorded; 0 for never',
        range=(0, 1_000_000),
    ),
    Parameter(
        'local_workers', -1, 'workers to start on this machine; -1: one per core', range=(-1, 256)
    ),
    Parameter(
        'worker_command',
        'ros2 run hexapod_bringup worker_node --ros-args -r __ns:=/{name}',
        'what starts a local worker; {name} stands for its namespace',
    ),
    Parameter(
        'worker_timeout',
        60.0,
        'longest wait for a worker while there is none',
        unit='s',
        range=(1.0, 86400.0),
    ),
    Parameter('attempts', 3, 'how often a failing row is tried', range=(1, 100)),
)


class Worker:
    """One worker: its action server, and the row that it has."""

    def __init__(self, node: Node, action: str) -> None:
        self.name = action.rsplit('/', 1)[0] or '/'
        self.client = ActionClient(node, TrainRun, action)
        self.row: Row | None = None
        self.gone = False
        self._seen = time.monotonic()

    def present(self) -> bool:
        """Whether the server is there; the name of an action may be that of a client alone."""
        if self.client.server_is_ready():
            self._seen = time.monotonic()
            return True
        return False

    def lost(self) -> bool:
        """Whether the server has been gone for a while."""
        return not self.present() and time.monotonic() - self._seen > _LOST_S


class ManagerNode(Node):
    """Hands out the plan's rows, counts what comes back and says how far it is."""

    def __init__(self) -> None:
        super().__init__('manager')
        declare(self, PARAMETERS)
        plan = Path(self._parameter('plan'))
        if not plan.is_file():
            raise FileNotFoundError(f"plan '{plan}': no such file, expected a plan.csv of `plan`")
        self._campaign = Campaign.open(plan, self._parameter('attempts'))
        self._workers: dict[str, Worker] = {}
        self._alone_since = time.monotonic()
        self._fault: Exception | None = None
        self.exit_status: int | None = None
        self._dashboard = Dashboard(self._campaign, self._parameter('episodes'))
        self._page = PageWriter(self._campaign.directory, self._dashboard.log)
        self._status_publisher = self.create_publisher(CampaignStatus, '~/status', LATCHED)
        self._local = LocalWorkers(
            0 if self._campaign.finished else self._worker_count(),
            self._parameter('worker_command'),
            self._campaign.directory / 'logs',
        )
        self.create_timer(_TICK_S, self._on_tick)
        self._publish_status()
        Diagnostics(self, self._health)

    def destroy_node(self) -> None:
        """Stop the local workers, then the node."""
        self._local.stop()
        self._page.close()
        self._dashboard.close()
        super().destroy_node()

    def _on_tick(self) -> None:
        """Notice new workers, lost ones, and the end."""
        if self._fault is not None:
            raise self._fault
        if self.exit_status is not None:
            return
        for text in self._local.revive():
            self._dashboard.log(text)
        self._discover()
        for worker in [w for w in self._workers.values() if w.lost()]:
            self._drop(worker)
        if self._campaign.finished:
            self.exit_status = self._close()
        if any(worker.present() for worker in self._workers.values()):
            self._alone_since = time.monotonic()
        elif time.monotonic() - self._alone_since > self._parameter('worker_timeout'):
            self._dashboard.log(
                f'no worker offers the action {_ACTION} after '
                f'{self._parameter("worker_timeout"):g} s: expected one from local_workers or '
                'from `ros2 launch hexapod_bringup worker.launch.xml`'
            )
            self.exit_status = 1

    def _discover(self) -> None:
        for action, types in get_action_names_and_types(self):
            if _ACTION in types and action not in self._workers:
                worker = Worker(self, action)
                self._workers[action] = worker
                start(self._serve(worker)).add_done_callback(self._on_served)

    def _on_served(self, served: Future) -> None:
        """Keep an error of a worker's coroutine for the next tick, which ends the node with it."""
        self._fault = served.exception() or self._fault

    async def _serve(self, worker: Worker) -> None:
        """Give a worker one row after another, for as long as it is there."""
        while not worker.gone and not worker.client.server_is_ready():
            await sleep(self, _TICK_S)
        while not worker.gone:
            row = self._campaign.take(worker.name)
            if row is None:
                await sleep(self, _TICK_S)
                continue
            worker.row = row
            await self._train(worker, row)
            worker.row = None
            self._publish_status()

    async def _train(self, worker: Worker, row: Row) -> None:
        """Have a worker train one row, and judge what comes back."""
        self._dashboard.begin(worker.name, row.run_id, row.observations)
        self._publish_status()
        goal_handle = await until(
            worker.client.send_goal_async(
                self._goal(row), feedback_callback=partial(self._on_feedback, worker, row)
            )
        )
        if not goal_handle.accepted:  # somebody else's run is under way there
            self._campaign.release(row)
            await sleep(self, _BUSY_S)
            return
        response = await until(goal_handle.get_result_async())
        if self._campaign.running.get(row.run_id) != worker.name:
            return  # it was given up and is another worker's by now
        if response.status == GoalStatus.STATUS_SUCCEEDED and self._campaign.complete(row):
            reward = response.result.final_average_reward
            text = f'{row.run_id}  sensors {row.observations or "none"}  reward {reward:.1f}'
            self._dashboard.end(worker.name, text, done=True)
            return
        if response.status != GoalStatus.STATUS_SUCCEEDED:
            self._campaign.fail(row, response.result.message or 'the run was aborted')
        reason = self._campaign.reasons[row.run_id][-1]
        self._dashboard.end(worker.name, f'{row.run_id} failed: {reason}', done=False)

    def _goal(self, row: Row) -> TrainRun.Goal:
        return TrainRun.Goal(
            run_id=row.run_id,
            observations=row.observations,
            seed=row.seed,
            episodes=self._parameter('episodes'),
            config=self._parameter('config'),
            bag=str(row.bag),
            record_every=self._parameter('record_every'),
            metadata=[KeyValue(key=key, value=value) for key, value in row.metadata.items()],
        )

    def _on_feedback(
        self, worker: Worker, row: Row, message: TrainRun.Impl.FeedbackMessage
    ) -> None:
        feedback = message.feedback
        self._dashboard.episode(worker.name, row.run_id, feedback.episode, feedback.episode_return)

    def _drop(self, worker: Worker) -> None:
        """Forget a worker that is gone; its row is due again."""
        self._workers = {name: w for name, w in self._workers.items() if w is not worker}
        if worker.row is not None:
            self._campaign.release(worker.row)
            self._dashboard.end(worker.name, f'{worker.name} is gone', done=False)
        worker.gone = True
        worker.client.destroy()

    def _close(self) -> int:
        """Say how the campaign ended; return the exit status."""
        campaign = self._campaign
        self._publish_status()
        for run_id in campaign.failed:
            self._dashboard.log(f'{run_id} failed: {campaign.reasons[run_id][-1]}')
        self._dashboard.log(
            f'{len(campaign.done)} of {len(campaign.rows)} runs are in {campaign.directory}'
        )
        return 1 if campaign.failed else 0

    def _publish_status(self) -> None:
        self._page.refresh()
        campaign = self._campaign
        rows = {worker.name: worker.row for worker in self._workers.values()}
        message = CampaignStatus(
            campaign=str(campaign.directory),
            rows=len(campaign.rows),
            done=len(campaign.done),
            failed=len(campaign.failed),
            workers=list(rows),
            running=[row.run_id if row else '' for row in rows.values()],
            episodes_per_second=self._dashboard.episodes_per_second,
            eta_seconds=self._dashboard.seconds_left,
        )
        message.header.stamp = self.get_clock().now().to_msg()
        self._status_publisher.publish(message)

    def _worker_count(self) -> int:
        count = int(self._parameter('local_workers'))
        return count if count >= 0 else os.cpu_count() or 1

    def _parameter(self, name: str) -> Any:
        return self.get_parameter(name).value

    def _health(self) -> Health:
        campaign = self._campaign
        level = DiagnosticStatus.WARN if campaign.failed else DiagnosticStatus.OK
        text = f'{len(campaign.done)} of {len(campaign.rows)} runs done'
        return level, text, {'failed': len(campaign.failed), 'workers': len(self._workers)}


def main(args: Sequence[str] | None = None) -> None:
    """Run the campaign to its end, or until a signal comes."""
    run(ManagerNode, args)
