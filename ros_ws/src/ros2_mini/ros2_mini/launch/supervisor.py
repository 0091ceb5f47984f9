# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Run the processes of a plan together, to their end or until the launch is interrupted."""

import asyncio
import contextlib
import signal

from ros2_mini.launch.log import LaunchLog
from ros2_mini.launch.plan import Plan, ProcessSpec
from ros2_mini.launch.process import ManagedProcess


class Supervisor:
    """Starts the processes of a plan and ends them together."""

    def __init__(self, plan: Plan, log: LaunchLog) -> None:
        self._plan = plan
        self._log = log
        self._stopping = asyncio.Event()
        self._failed = False

    async def run(self) -> int:
        """Run until every process has ended.

        Returns:
            1 if a process failed for good while nobody was stopping the launch, else 0.
        """
        loop = asyncio.get_running_loop()
        for number in (signal.SIGINT, signal.SIGTERM):
            loop.add_signal_handler(number, self._interrupted, number)
        for message in self._plan.messages:
            self._log.say('INFO', 'launch.user', message)
        if self._plan.shutdown is not None:
            self._log.say('INFO', 'launch', f'process[shutdown]: {self._plan.shutdown}')
            return 0
        await asyncio.gather(*map(self._supervise, self._plan.processes))
        return int(self._failed)

    def _interrupted(self, number: signal.Signals) -> None:
        text = (
            f'user interrupted with {"ctrl-c (SIGINT)" if number == signal.SIGINT else "SIGTERM"}'
        )
        again = ' again, ignoring...' if self._stopping.is_set() else ''
        self._log.say('WARNING', 'launch', text + again)
        self._stopping.set()

    async def _supervise(self, spec: ProcessSpec) -> None:
        """Keep one process of the plan going as its respawn settings say."""
        restarts = 0
        while True:
            status = await self._run_once(spec)
            if self._stopping.is_set():
                return
            if not spec.respawn or restarts == spec.respawn_max_retries:
                break
            restarts += 1
            with contextlib.suppress(TimeoutError):
                await asyncio.wait_for(self._stopping.wait(), spec.respawn_delay)
                return
        self._failed |= status != 0
        if spec.shutdown_on_exit:
            self._stopping.set()

    async def _run_once(self, spec: ProcessSpec) -> int:
        """Run a process to its end; return its exit status, 127 if it could not be started."""
        if self._stopping.is_set():
            return 0
        try:
            process = await ManagedProcess.start(spec, self._log)
        except OSError as error:
            reason = f"cannot run '{spec.command[0]}': {error.strerror}"
            self._log.say('ERROR', spec.name, reason)
            return 127
        ended = asyncio.ensure_future(process.wait())
        stopping = asyncio.ensure_future(self._stopping.wait())
        await asyncio.wait((ended, stopping), return_when=asyncio.FIRST_COMPLETED)
        if not ended.done():
            await process.stop()
        stopping.cancel()
        return await ended
