# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""One child process of a launch: its start, its output line by line, and its end by signals."""

import asyncio
import contextlib
import os
import signal
from asyncio.subprocess import DEVNULL, Process
from dataclasses import dataclass

from ros2_mini.launch.log import LaunchLog
from ros2_mini.launch.plan import ProcessSpec

# A process that has ended may leave a child of its own that holds the pipes open: how long to
# wait for the rest of the output [s].
_DRAIN_TIMEOUT = 0.5


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
        command = ('/bin/sh', '-c', ' '.join(spec.command)) if spec.shell else spec.command
        pipes = [await _Pipe.open(), await _Pipe.open()]
        try:
            process = await asyncio.create_subprocess_exec(
                *command,
                cwd=spec.cwd,
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
        steps = (
            (signal.SIGINT, self.spec.sigterm_timeout),
            (signal.SIGTERM, self.spec.sigkill_timeout),
        )
        for number, timeout in steps:
            self._send(number)
            with contextlib.suppress(TimeoutError):
                await asyncio.wait_for(self._process.wait(), timeout)
                return
            self._log.say(
                'ERROR',
                self.spec.name,
                f"process[{self.spec.name}] failed to terminate '{timeout:g}' seconds after "
                f"receiving '{number.name}', escalating",
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
