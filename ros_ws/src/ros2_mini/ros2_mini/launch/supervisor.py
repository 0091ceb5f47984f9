# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Run the processes of a plan together, to their end or until the launch is interrupted."""

import asyncio
import contextlib
import os
import signal
from asyncio.subprocess import DEVNULL, Process
from dataclasses import dataclass, field

from ros2_mini.launch.log import LaunchLog

OUTPUTS = ('screen', 'log', 'both')
# A process that has ended may leave a child of its own that holds the pipes open: how long to
# wait for the rest of the output [s].
_DRAIN_TIMEOUT = 0.5
# A process that does not heed a signal gets the next one after that [s].
PATIENCE = 5.0


@dataclass(frozen=True)
class ProcessSpec:
    """One process to start and keep an eye on."""

    name: str
    """Name in the output, such as `sim_node-1`."""
    command: tuple[str, ...]
    environment: dict[str, str]
    output: str = 'log'
    """`screen`, `both`, or `log`: then only standard error reaches the screen."""
    shutdown_on_exit: bool = False


@dataclass
class Plan:
    """The processes of one launch, in the order of the files."""

    processes: list[ProcessSpec] = field(default_factory=list)
    arguments: set[str] = field(default_factory=set)
    """Names that some file declares as an argument."""


@dataclass(frozen=True)
class _Pipe:
    """A pipe of our own: asyncio's would make the wait for a process one for its children too."""

    reader: asyncio.StreamReader
    transport: asyncio.ReadTransport
    write_end: int

    @classmethod
    async def open(cls) -> '_Pipe':
        read_end, write_end = os.pipe()
        reader = asyncio.StreamReader()
        transport, _ = await asyncio.get_running_loop().connect_read_pipe(
            lambda: asyncio.StreamReaderProtocol(reader), os.fdopen(read_end, 'rb')
        )
        return cls(reader, transport, write_end)


class ManagedProcess:
    """A running process of a launch, in a process group of its own.

    The group keeps a Ctrl-C of the terminal away, so that the launch passes on exactly one SIGINT;
    a signal goes to the whole group, as it would from the terminal.
    """

    def __init__(
        self, spec: ProcessSpec, process: Process, pipes: list[_Pipe], log: LaunchLog
    ) -> None:
        self.spec = spec
        self._process = process
        self._pipes = pipes
        self._log = log
        screens = (spec.output != 'log', True)
        self._pumps = [
            asyncio.ensure_future(self._pump(pipe.reader, screen))
            for pipe, screen in zip(pipes, screens, strict=True)
        ]

    @classmethod
    async def start(cls, spec: ProcessSpec, log: LaunchLog) -> 'ManagedProcess':
        """Start a process.

        Raises:
            OSError: If the command cannot be run.
        """
        pipes = [await _Pipe.open(), await _Pipe.open()]
        try:
            process = await asyncio.create_subprocess_exec(
                *spec.command,
                env=spec.environment,
                stdin=DEVNULL,
                stdout=pipes[0].write_end,
                stderr=pipes[1].write_end,
                process_group=0,
            )
        finally:
            for pipe in pipes:
                os.close(pipe.write_end)
        log.say('INFO', spec.name, f'process started with pid [{process.pid}]')
        return cls(spec, process, pipes, log)

    async def wait(self) -> int:
        """Return the exit status once the process has ended and its output has been written."""
        status = await self._process.wait()
        await asyncio.wait(self._pumps, timeout=_DRAIN_TIMEOUT)
        for pipe, pump in zip(self._pipes, self._pumps, strict=True):
            pump.cancel()
            pipe.transport.close()
        pid = self._process.pid
        if status == 0:
            self._log.say('INFO', self.spec.name, f'process has finished cleanly [pid {pid}]')
        else:
            command = ' '.join(self.spec.command)
            self._log.say(
                'ERROR',
                self.spec.name,
                f"process has died [pid {pid}, exit code {status}, cmd '{command}'].",
            )
        return status

    async def stop(self) -> None:
        """End the process: SIGINT, and if it does not heed that in time SIGTERM, then SIGKILL."""
        for number in (signal.SIGINT, signal.SIGTERM):
            self._send(number)
            with contextlib.suppress(TimeoutError):
                await asyncio.wait_for(self._process.wait(), PATIENCE)
                return
            self._log.say(
                'ERROR',
                self.spec.name,
                f"process[{self.spec.name}] failed to terminate '{PATIENCE:g}' seconds "
                f"after receiving '{number.name}', escalating",
            )
        self._send(signal.SIGKILL)

    def _send(self, number: signal.Signals) -> None:
        if self._process.returncode is not None:
            return
        name = self.spec.name
        self._log.say('INFO', name, f"sending signal '{number.name}' to process[{name}]")
        with contextlib.suppress(ProcessLookupError):
            os.killpg(self._process.pid, number)

    async def _pump(self, reader: asyncio.StreamReader, screen: bool) -> None:
        """Write what comes out of a pipe, a line at a time, the unfinished last line included."""
        rest = b''
        while chunk := await reader.read(65536):
            *lines, rest = (rest + chunk).split(b'\n')
            for line in lines:
                self._write(line, screen)
        if rest:
            self._write(rest, screen)

    def _write(self, line: bytes, screen: bool) -> None:
        text = line.decode(errors='replace').removesuffix('\r')
        self._log.line(self.spec.name, text, screen=screen, file=self.spec.output != 'screen')


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
            1 if a process failed while nobody was stopping the launch, else 0.
        """
        loop = asyncio.get_running_loop()
        for number in (signal.SIGINT, signal.SIGTERM):
            loop.add_signal_handler(number, self._interrupted, number)
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
        """Run one process of the plan to its end, or that of the launch."""
        if self._stopping.is_set():
            return
        try:
            process = await ManagedProcess.start(spec, self._log)
        except OSError as error:
            reason = f"cannot run '{spec.command[0]}': {error.strerror}"
            self._log.say('ERROR', spec.name, reason)
            status = 127
        else:
            status = await self._watch(process)
        if not self._stopping.is_set():
            self._failed |= status != 0
            if spec.shutdown_on_exit:
                self._stopping.set()

    async def _watch(self, process: ManagedProcess) -> int:
        """Return the exit status of a process, which is ended if the launch is to stop."""
        ended = asyncio.ensure_future(process.wait())
        stopping = asyncio.ensure_future(self._stopping.wait())
        await asyncio.wait((ended, stopping), return_when=asyncio.FIRST_COMPLETED)
        if not ended.done():
            await process.stop()
        stopping.cancel()
        return await ended
