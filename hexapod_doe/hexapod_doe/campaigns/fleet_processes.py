# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Fleets in processes side by side, which share out the rows of a campaign by their locks."""

import sys
import time
from collections.abc import Sequence
from pathlib import Path

from rich.console import Console
from rich.live import Live

from hexapod_doe.campaigns import children
from hexapod_doe.campaigns.folder import read_progress
from hexapod_doe.campaigns.overview import overview, summary
from hexapod_doe.campaigns.progress import State

_POLL_S = 0.2
_SCREEN_S, _LINE_S = 2.0, 10.0
_WELL = (0, 1)  # all rows are done; some are not, as they are at another process or failed


def train_in_processes(directory: Path, count: int, options: Sequence[str]) -> list[str]:
    """Let so many `run_fleet` train what is due, each one row at a time, and show how far it is.

    Args:
        directory: the campaign's folder, with its plan; what they print goes to `logs` in it.
        count: how many.
        options: of `run_fleet`, for each of them.

    Returns:
        What went wrong, a line for each row that failed and for each process that broke down,
        whose row stays due.
    """
    logs = directory / 'logs'
    logs.mkdir(parents=True, exist_ok=True)
    command = [sys.executable, '-m', 'hexapod_doe.run_fleet', '--processes', '1', *options]
    files = [logs / f'fleet_{number + 1}.log' for number in range(count)]
    fleets = [children.start(command, file, {}) for file in files]
    try:
        _show(directory, fleets)
    finally:
        children.stop(fleets)
    failed = read_progress(directory).having(State.FAILED)
    return [f'{run.run_id} failed: {run.reason}' for run in failed] + [
        f'{file.stem} ended with status {fleet.returncode}, see {file}'
        for file, fleet in zip(files, fleets, strict=True)
        if fleet.returncode not in _WELL
    ]


def _show(directory: Path, fleets: Sequence[children.Child]) -> None:
    """Show the campaign as its folder has it, until all processes have ended."""
    console = Console(highlight=False)
    progress = read_progress(directory)
    period_s = _SCREEN_S if console.is_terminal else _LINE_S
    shown = time.monotonic()
    with Live(console=console, auto_refresh=False) as live:
        while any(fleet.poll() is None for fleet in fleets):
            time.sleep(_POLL_S)
            if time.monotonic() - shown < period_s:
                continue
            progress = read_progress(directory, progress.runs)
            if console.is_terminal:
                runs = progress.having(State.RUNNING, State.FAILED)
                live.update(overview(progress, runs), refresh=True)
            else:
                console.print(summary(progress))
            shown = time.monotonic()
