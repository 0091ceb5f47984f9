# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A running campaign on the terminal: a screen that is kept up to date, or lines in a log."""

import math
import time

from rich.console import Console, RenderableType
from rich.live import Live

from hexapod_doe.campaigns.campaign import Campaign
from hexapod_doe.campaigns.folder import read_row
from hexapod_doe.campaigns.overview import overview, pace
from hexapod_doe.campaigns.progress import Progress, Run, State

_LOG_PERIOD_S = 10.0
_FINISHED_SHOWN = 8


class Dashboard:
    """Follows a campaign through what its manager tells, and shows it."""

    def __init__(self, campaign: Campaign, console: Console | None = None) -> None:
        """Begin with the rows that are done.

        Args:
            campaign: whose failures are shown, too.
            console: where to show it; the terminal unless given.
        """
        self._campaign = campaign
        self._rows = {row.run_id: row for row in campaign.rows}
        self._current: dict[str, Run] = {}
        self._began: dict[str, float] = {}
        self._finished: list[Run] = []
        self._last_log = time.monotonic()
        length = campaign.base.training.episodes
        runs = [Run(r.run_id, r.label, planned=length) for r in campaign.rows]
        for run in runs:
            if run.run_id in campaign.done:
                run.state = State.DONE
                run.returns = [math.nan] * length  # counted, but not seen
        self.progress = Progress(
            campaign.directory.name, {run.run_id: run for run in runs}, campaign.legend
        )
        self._console = console or Console(highlight=False)
        self._live = Live(
            get_renderable=self._screen, console=self._console, refresh_per_second=1.0
        )
        if self._console.is_terminal:
            self._live.start()

    @property
    def episodes_per_second(self) -> float:
        """Rate of all workers together."""
        return self.progress.episodes_per_second

    @property
    def seconds_left(self) -> float:
        """Expected time to the end, NaN while nothing is known."""
        return self.progress.seconds_left

    def begin(self, worker: str, run_id: str) -> None:
        """Show a run with its worker."""
        run = self._current[worker] = self.progress.runs[run_id]
        self._began[worker] = time.monotonic()
        run.state, run.worker = State.RUNNING, worker
        run.returns, run.seconds, run.earlier, run.reason = [], 0.0, 0, ''

    def episode(self, worker: str, run_id: str, episode: int, episode_return: float) -> None:
        """Count one finished episode."""
        run = self._current.get(worker)
        if run is None or run.run_id != run_id:
            return  # the run was given up meanwhile
        if not run.returns:  # what it had before it was begun again
            run.earlier = episode
            run.returns = [math.nan] * episode
        run.returns[episode:] = [episode_return]
        run.seconds = time.monotonic() - self._began[worker]
        self._log_pace()

    def end(self, worker: str, text: str, done: bool) -> None:
        """Count a finished run, or take back one that failed."""
        run = self._current.pop(worker, None)
        if run is None:  # it was lost before it began
            self.log(text)
            return
        if done:
            run = read_row(self._rows[run.run_id])
            self.progress.runs[run.run_id] = run
            self._finished.append(run)
        elif run.run_id in self._campaign.failed:
            run.state = State.FAILED
            run.reason = self._campaign.reasons[run.run_id][-1]
        else:
            run.state, run.returns, run.earlier = State.DUE, [], 0
        rows = self.progress.runs
        self.log(f'{len(self.progress.having(State.DONE))}/{len(rows)} {text}')

    def log(self, text: str) -> None:
        """Print a line above the screen."""
        self._console.print(text, markup=False, soft_wrap=True)

    def close(self) -> None:
        """Leave the terminal as it was, with the last screen on it."""
        self._live.stop()

    def _screen(self) -> RenderableType:
        shown = [*self.progress.having(State.RUNNING), *self._finished[-_FINISHED_SHOWN:]]
        return overview(self.progress, [*shown, *self.progress.having(State.FAILED)])

    def _log_pace(self) -> None:
        if self._console.is_terminal or time.monotonic() - self._last_log < _LOG_PERIOD_S:
            return
        self._last_log = time.monotonic()
        progress = self.progress
        self.log(f'{progress.episodes}/{progress.planned} episodes, {pace(progress)}')
