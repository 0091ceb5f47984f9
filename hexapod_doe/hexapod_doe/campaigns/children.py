# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Processes of a campaign on this machine: each in a session of its own, none outlives us."""

import os
import signal
import subprocess
import time
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path

from hexapod_doe.campaigns.leash import leashed

Child = subprocess.Popen[bytes]

_STOP_S = 8.0  # all of them together; the end of their starter is limited, too


def start(command: Sequence[str], log: Path, environment: Mapping[str, str]) -> Child:
    """Start one, on one core's share of mathematics; what it prints is added to a file.

    Its standard input stays open, and is never written to, as long as this process lives.
    """
    own = {'OMP_NUM_THREADS': '1', 'MKL_NUM_THREADS': '1', **environment}
    with log.open('ab') as file:
        return subprocess.Popen(
            leashed(list(command)),
            stdin=subprocess.PIPE,
            stdout=file,
            stderr=subprocess.STDOUT,
            env=os.environ | own,
            start_new_session=True,  # Ctrl-C reaches their starter, who ends them in order
        )


def stop(children: Iterable[Child]) -> None:
    """Ask all to end, as Ctrl-C does, and end those that have not after a while."""
    asked = list(children)
    for child in asked:
        if child.poll() is None:  # else its number may be a stranger's by now
            _signal(child, signal.SIGINT)
    deadline = time.monotonic() + _STOP_S
    for child in asked:
        try:
            child.wait(max(deadline - time.monotonic(), 0.0))
        except subprocess.TimeoutExpired:
            kill(child)
            child.wait()


def kill(child: Child) -> None:
    """End one and whatever it started, at once."""
    _signal(child, signal.SIGKILL)


def _signal(child: Child, number: signal.Signals) -> None:
    """Signal one and whatever it started: `ros2 run` waits for a node, and hands nothing on."""
    with suppress(ProcessLookupError):  # all of it has ended
        os.killpg(child.pid, number)
