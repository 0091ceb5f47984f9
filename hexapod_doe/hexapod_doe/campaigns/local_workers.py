# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Workers of a campaign as processes on this machine."""

from __future__ import annotations

import os
import shlex
import signal
import subprocess
from pathlib import Path

_STOP_S = 10.0


class LocalWorkers:
    """Starts one process per worker, starts it again if it dies, and stops them all."""

    def __init__(self, count: int, command: str, logs: Path) -> None:
        """Start the workers.

        Args:
            count: how many.
            command: what starts a worker; `{name}` stands for its namespace.
            logs: directory for what they print.
        """
        self._command = command
        self._logs = logs
        logs.mkdir(parents=True, exist_ok=True)
        self._processes = {
            name: self._start(name) for name in (f'worker_{n + 1}' for n in range(count))
        }

    def revive(self) -> list[str]:
        """Start again what has died; return the names and exit statuses in words."""
        dead = {name: p for name, p in self._processes.items() if p.poll() is not None}
        for name in dead:
            self._processes[name] = self._start(name)
        return [
            f'{name} ended with status {process.returncode}, see {self._log(name)}'
            for name, process in dead.items()
        ]

    def stop(self) -> None:
        """Ask every worker to end, and end those that do not."""
        for process in self._processes.values():
            if process.poll() is None:
                process.send_signal(signal.SIGINT)
        for process in self._processes.values():
            try:
                process.wait(_STOP_S)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()

    def _log(self, name: str) -> Path:
        return self._logs / f'{name}.log'

    def _start(self, name: str) -> subprocess.Popen[bytes]:
        # One worker per core: the mathematics of a worker must not spread over the others'.
        environment = os.environ | {'OMP_NUM_THREADS': '1', 'MKL_NUM_THREADS': '1'}
        with self._log(name).open('ab') as log:
            return subprocess.Popen(
                shlex.split(self._command.format(name=name)),
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=subprocess.STDOUT,
                env=environment,
                start_new_session=True,  # Ctrl-C reaches the manager, which ends them in order
            )
