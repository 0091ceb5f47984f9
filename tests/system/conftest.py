# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Commands and nodes as processes of their own, as a user starts them."""

from __future__ import annotations

import io
import os
import signal
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import chdir, redirect_stderr, redirect_stdout
from pathlib import Path
from pkgutil import resolve_name

import pytest
import rclpy
from rclpy.node import Node
from understood import console_main


class Shell:
    """Runs `ros2` lines and keeps what runs on, to end it with the test."""

    def __init__(self, directory: Path) -> None:
        self.directory = directory
        self._running: list[subprocess.Popen[str]] = []

    def run(self, line: str, timeout_s: float = 60.0) -> subprocess.CompletedProcess[str]:
        """Run a command to its end."""
        return subprocess.run(
            line.split(),
            capture_output=True,
            text=True,
            timeout=timeout_s,
            cwd=self.directory,
            check=False,
        )

    def call(self, line: str) -> subprocess.CompletedProcess[str]:
        """Carry out a line of `ros2 run` in this process, which has loaded the libraries.

        For what makes ready or looks back: what a test is about has a process of its own.
        """
        _, _, package, executable, *words = line.split()
        printed, complained = io.StringIO(), io.StringIO()
        with chdir(self.directory), redirect_stdout(printed), redirect_stderr(complained):
            try:
                status = resolve_name(console_main(package, executable))(words)
            except SystemExit as ended:
                status = ended.code
        return subprocess.CompletedProcess(
            line, int(status or 0), printed.getvalue(), complained.getvalue()
        )

    def start(self, line: str) -> subprocess.Popen[str]:
        """Start a command that runs on; what it prints goes to a file."""
        with (self.directory / f'output_{len(self._running)}').open('w') as output:
            process = subprocess.Popen(
                line.split(),
                stdout=output,
                stderr=subprocess.STDOUT,
                text=True,
                cwd=self.directory,
                start_new_session=True,
            )
        self._running.append(process)
        return process

    def until(self, predicate: Callable[[], bool], timeout_s: float = 30.0) -> None:
        """Wait for something that another process does."""
        deadline = time.monotonic() + timeout_s
        while not predicate():
            assert time.monotonic() < deadline, self.output()
            time.sleep(0.2)

    def output(self) -> str:
        """Return what all started commands have printed."""
        return '\n'.join(file.read_text() for file in sorted(self.directory.glob('output_*')))

    def stop(self) -> None:
        """End what still runs."""
        for process in self._running:
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGINT)
        for process in self._running:
            try:
                process.wait(15.0)
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, signal.SIGKILL)
                process.wait()


@pytest.fixture
def shell(tmp_path: Path) -> Iterator[Shell]:
    """Yield a shell in a directory of its own; everything that it started ends with the test."""
    made = Shell(tmp_path)
    yield made
    made.stop()


@pytest.fixture(scope='module', autouse=True)
def _isolated(own_domain: int) -> None:
    """Keep the processes of these tests among themselves."""


@pytest.fixture
def observer(own_domain: int) -> Iterator[Node]:
    """Yield a node that sees the others, in less time than `ros2 node list` takes to start."""
    context = rclpy.Context()
    rclpy.init(context=context, domain_id=own_domain)
    node = Node('observer', context=context)
    yield node
    node.destroy_node()
    context.shutdown()
