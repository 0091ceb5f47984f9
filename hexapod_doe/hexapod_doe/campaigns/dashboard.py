# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Progress of a campaign on the terminal: a bar with the time left, or lines where it is a log."""

from __future__ import annotations

import time

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TaskID, TextColumn

_LOG_PERIOD_S = 10.0


class Dashboard:
    """Counts episodes and shows how many are left."""

    def __init__(self, rows: int, done: int, episodes_per_row: int) -> None:
        self._rows = rows
        self._done_rows = done
        self._per_row = episodes_per_row
        self._started = time.monotonic()
        self._fresh = 0
        self._current: dict[str, int] = {}
        self._last_log = self._started
        self._console = Console()
        self._progress = Progress(
            TextColumn('{task.description}'),
            BarColumn(),
            MofNCompleteColumn(),
            TextColumn('{task.fields[note]}'),
            console=self._console,
            disable=not self._console.is_terminal,
        )
        self._total = self._progress.add_task(
            'episodes', total=rows * episodes_per_row, completed=done * episodes_per_row, note=''
        )
        self._bars: dict[str, TaskID] = {}
        self._progress.start()

    @property
    def episodes_per_second(self) -> float:
        """Rate since the start."""
        return self._fresh / max(time.monotonic() - self._started, 1e-9)

    @property
    def seconds_left(self) -> float:
        """Expected time to the end, NaN while nothing is known."""
        left = (self._rows - self._done_rows) * self._per_row - sum(self._current.values())
        return left / self.episodes_per_second if self._fresh else float('nan')

    def begin(self, worker: str, run_id: str, observations: str) -> None:
        """Show a run on its worker's line."""
        self._current[worker] = 0
        if worker not in self._bars:
            self._bars[worker] = self._progress.add_task(worker, total=self._per_row, note='')
        note = f'{run_id}  sensors {observations or "none"}'
        self._progress.reset(self._bars[worker], total=self._per_row, note=note)

    def episode(self, worker: str, run_id: str, episode: int, episode_return: float) -> None:
        """Count one finished episode."""
        self._fresh += 1
        self._current[worker] = episode + 1
        self._progress.update(
            self._bars[worker],
            completed=episode + 1,
            note=f'{run_id}  return {episode_return:.0f}',
        )
        self._refresh()

    def end(self, worker: str, text: str, done: bool) -> None:
        """Count a finished run, or take back one that failed."""
        self._current[worker] = 0
        self._done_rows += done
        self._refresh()
        self.log(f'{self._done_rows}/{self._rows} {text}')

    def log(self, text: str) -> None:
        """Print a line above the bars."""
        self._console.print(text, highlight=False, markup=False, soft_wrap=True)

    def close(self) -> None:
        """Leave the terminal as it was."""
        self._progress.stop()

    def _refresh(self) -> None:
        completed = self._done_rows * self._per_row + sum(self._current.values())
        note = f'{self.episodes_per_second:.2f}/s  {_duration(self.seconds_left)} left'
        self._progress.update(self._total, completed=completed, note=note)
        if not self._console.is_terminal and time.monotonic() - self._last_log > _LOG_PERIOD_S:
            self._last_log = time.monotonic()
            self.log(f'{completed}/{self._rows * self._per_row} episodes, {note}')


def _duration(seconds: float) -> str:
    if seconds != seconds:
        return '?'
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f'{hours}:{minutes:02}:{rest:02}' if hours else f'{minutes}:{rest:02}'
