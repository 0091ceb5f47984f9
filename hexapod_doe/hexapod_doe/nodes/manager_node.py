# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Node `manager`: runs a plan on every worker that it discovers."""

import shlex
import time
from collections.abc import Sequence
from contextlib import ExitStack
from functools import partial
from pathlib import Path
from typing import Any

from diagnostic_msgs.msg import DiagnosticStatus
from hexapod_agent.nodes.action_names import TRAIN_RUN
from hexapod_interfaces.action import TrainRun
from hexapod_interfaces.msg import CampaignStatus
from hexapod_node.actions import ActionClient
from hexapod_node.coroutines import in_thread, sleep, start
from hexapod_node.diagnostics import Diagnostics, Health
from hexapod_node.node import Node
from hexapod_node.parameters import declare
from hexapod_node.qos import LATCHED
from hexapod_node.root import root_arguments
from hexapod_node.shared_memory import free_abandoned
from hexapod_node.spin import run
from hexapod_node.timers import call_every
from rclpy.action import get_action_names_and_types
from rclpy.task import Future

from hexapod_doe.analysis.stop_look import look_at
from hexapod_doe.campaigns.campaign import Campaign
from hexapod_doe.campaigns.campaign_lock import campaign_lock
from hexapod_doe.campaigns.changes import Changes
from hexapod_doe.campaigns.dashboard import Dashboard
from hexapod_doe.campaigns.failures import FailureLog
from hexapod_doe.campaigns.forecast import forecast
from hexapod_doe.campaigns.local_workers import LocalWorkers
from hexapod_doe.campaigns.page import PageWriter
from hexapod_doe.campaigns.plan_copy import keep_config
from hexapod_doe.campaigns.row import RUNS_FOLDER, Row
from hexapod_doe.campaigns.stop_rule import StopRule, go_on
from hexapod_doe.cores import usable_cores
from hexapod_doe.errors import CampaignError
from hexapod_doe.nodes.manager_parameters import PARAMETERS
from hexapod_doe.nodes.train_goal import train_goal
from hexapod_doe.nodes.worker_client import Ended, WorkerBusyError, WorkerClient, WorkerLostError

_ACTION = 'hexapod_interfaces/action/TrainRun'
_TICK_S = 0.2
_BUSY_S = 2.0


class ManagerNode(Node):
    """Hands out the plan's rows, counts what comes back and says how far it is."""

    def __init__(self) -> None:
        super().__init__('manager')
        declare(self, PARAMETERS)
        plan = Path(self._parameter('plan')).expanduser()
        if not plan.is_file():
            raise FileNotFoundError(f"plan '{plan}': no such file, expected a plan.csv of `plan`")
        self._held = ExitStack()
        self._held.enter_context(campaign_lock(plan.resolve().parent))
        if self._parameter('go_on'):
            go_on(plan.resolve().parent)
        changes = Changes.of(*(self._parameter(name) for name in ('config', 'set', 'episodes')))
        self._campaign = Campaign.open(plan, self._parameter('attempts'), changes)
        self._campaign.check_own()
        self._campaign.forget_cuts()
        keep_config(plan.resolve(), self._campaign.base)
        cases = len({row.levels for row in self._campaign.rows})
        self._rule = StopRule(
            self._campaign.directory, cases, self._parameter('stop_when'), look_at
        )
        self._looking = False
        self._failures = FailureLog(self._campaign.directory)
        self._failures.clear()
        self._workers: dict[str, WorkerClient] = {}
        self._buried: set[str] = set()
        """Names of local workers that died; the network knows them for a while."""
        self._alone_since = time.monotonic()
        self._fault: Exception | None = None
        self.exit_status: int | None = None
        self._dashboard = Dashboard(self._campaign)
        for run_id, damage in self._campaign.damaged.items():
            self._dashboard.log(f'{run_id} is trained anew: {damage}')
        self._page = PageWriter(self._campaign.directory, self._dashboard.log)
        self._status_publisher = self.create_publisher(CampaignStatus, '~/status', LATCHED)
        count = 0 if self._campaign.finished else self._worker_count()
        if not self._campaign.finished and (due := self._campaign.due):
            self._dashboard.log(forecast([row.spec for row in due], count))
        files = root_arguments((self._campaign.directory / RUNS_FOLDER).resolve())
        logs = self._campaign.directory / 'logs'
        command = self._parameter('worker_command')
        self._local = LocalWorkers(count, command, logs, shlex.join(files))
        call_every(self, _TICK_S, self._on_tick)
        self._publish_status()
        Diagnostics(self, self._health)

    def destroy_node(self) -> None:
        """Stop the local workers, then the node."""
        self._local.stop()
        self._page.close()
        self._dashboard.close()
        self._held.close()
        super().destroy_node()

    def _on_tick(self) -> None:
        """Notice new workers, lost ones, and the end."""
        if self._fault is not None:
            raise self._fault
        if self.exit_status is not None:
            return
        for name, end in self._local.revive().items():
            self._dashboard.log(f'{name} {end}')
            self._buried.add(f'/{name}')
        self._discover()
        for worker in list(self._workers.values()):
            if worker.name in self._buried or worker.lost():
                worker.gone = 'its process is gone'
                del self._workers[worker.name]
        if not (self._looking or self._campaign.stopped) and self._rule.due():
            self._looking = True
            start(self._look()).add_done_callback(self._on_served)
        if self._campaign.finished and not self._looking:
            self.exit_status = self._close()
        elif (
            self._looking
            or self._campaign.running
            or any(worker.ready for worker in self._workers.values())
        ):
            self._alone_since = time.monotonic()
        elif time.monotonic() - self._alone_since > self._parameter('worker_timeout'):
            self._dashboard.log(
                f'no worker offers the action {_ACTION} after '
                f'{self._parameter("worker_timeout"):g} s: expected one from local_workers or '
                'from `ros2 launch hexapod_bringup worker.launch.xml`'
            )
            self.exit_status = 1

    async def _look(self) -> None:
        """Ask the stop rule, while no new row is begun."""
        try:
            self._campaign.stopped = await in_thread(self, self._rule.look)
        finally:
            self._looking = False

    def _discover(self) -> None:
        for action, types in get_action_names_and_types(self):
            name, _, kind = action.rpartition('/')
            name = name or '/'
            # One that is there to play offers its action by another name.
            if (
                kind == TRAIN_RUN
                and _ACTION in types
                and name not in self._workers
                and name not in self._buried
            ):
                client = ActionClient(self, TrainRun, action)
                worker = WorkerClient(self, client, name, self._parameter('stall_timeout'))
                self._workers[name] = worker
                start(self._serve(worker)).add_done_callback(self._on_served)

    def _on_served(self, served: Future) -> None:
        """Keep an error of a worker's coroutine for the next tick, which ends the node with it."""
        self._fault = served.exception() or self._fault

    async def _serve(self, worker: WorkerClient) -> None:
        """Give a worker one row after another, for as long as it is there."""
        while not worker.gone:
            ready = worker.ready and not self._looking
            row = self._campaign.take(worker.name, self._workers) if ready else None
            if row is None or self.exit_status is not None:
                await sleep(self, _TICK_S)
                continue
            await self._train(worker, row)
            self._publish_status()
        worker.close()

    async def _train(self, worker: WorkerClient, row: Row) -> None:
        """Have a worker train one row, and judge what comes back."""
        try:
            ended = await worker.train(
                train_goal(row, self._parameter('record_every')),
                partial(self._dashboard.episode, worker.name, row.run_id),
                partial(self._on_begin, worker, row),
            )
        except WorkerBusyError:
            self._campaign.release(row)
            await sleep(self, _BUSY_S)
        except WorkerLostError as error:
            self._campaign.release(row, tried=True)
            self._dashboard.end(worker.name, f'{row.run_id} is due again, {error}', done=False)
            self._local.kill(worker.name.strip('/'))
        else:
            self._judge(worker, row, ended)

    def _on_begin(self, worker: WorkerClient, row: Row) -> None:
        self._dashboard.begin(worker.name, row.run_id)
        self._publish_status()

    def _judge(self, worker: WorkerClient, row: Row, ended: Ended) -> None:
        """Count a row as done if its bag is whole, whatever the worker says."""
        reason = ended.message or f'bag {row.bag} is not complete'
        if self._campaign.complete(row, reason):
            text = f'{row.run_id}  {row.text}  reward {ended.reward:.1f}'
            self._dashboard.end(worker.name, text, done=True)
            return
        self._dashboard.end(worker.name, f'{row.run_id} failed: {reason}', done=False)
        try:
            self._campaign.check_writable()
            self._failures.add(row.run_id, worker.name, reason)
        except CampaignError as error:  # no fault of the row: nothing can be done here
            self._dashboard.log(str(error))
            self.exit_status = 1

    def _close(self) -> int:
        """Say how the campaign ended; return the exit status."""
        campaign = self._campaign
        self._publish_status()
        for run_id in campaign.failed:
            self._dashboard.log(f'{run_id} failed: {campaign.reasons[run_id][-1]}')
        self._dashboard.log(
            f'{len(campaign.done)} of {len(campaign.rows)} runs are in {campaign.directory}'
        )
        if campaign.stopped:
            self._dashboard.log(f'{campaign.stopped}; go_on:=true trains the others')
        return 1 if campaign.failed else 0

    def _publish_status(self) -> None:
        self._page.refresh()
        campaign = self._campaign
        rows = {worker: run_id for run_id, worker in campaign.running.items()}
        message = CampaignStatus(
            campaign=str(campaign.directory),
            rows=len(campaign.rows),
            done=len(campaign.done),
            failed=len(campaign.failed),
            workers=list(self._workers),
            running=[rows.get(name, '') for name in self._workers],
            episodes_per_second=self._dashboard.episodes_per_second,
            eta_seconds=self._dashboard.seconds_left,
        )
        message.header.stamp = self.get_clock().now().to_msg()
        self._status_publisher.publish(message)

    def _worker_count(self) -> int:
        count = int(self._parameter('local_workers'))
        return count if count >= 0 else usable_cores()

    def _parameter(self, name: str) -> Any:
        return self.get_parameter(name).value

    def _health(self) -> Health:
        campaign = self._campaign
        level = DiagnosticStatus.WARN if campaign.failed else DiagnosticStatus.OK
        text = f'{len(campaign.done)} of {len(campaign.rows)} runs done'
        return level, text, {'failed': len(campaign.failed), 'workers': len(self._workers)}


def main(args: Sequence[str] | None = None) -> None:
    """Run the campaign to its end, or until a signal comes."""
    free_abandoned()
    run(ManagerNode, args)
