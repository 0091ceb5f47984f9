# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""How far a campaign is: the figures that terminal, page and status message all show."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from enum import StrEnum

from hexapod_doe.bags.run_identity import odd_runs


class State(StrEnum):
    """What has become of a row of the plan."""

    DONE = 'done'
    FAILED = 'failed'
    RUNNING = 'running'
    INTERRUPTED = 'interrupted'
    """It was begun, and nobody works at it now."""
    OTHER = 'other'
    """The bag in its place is that of another run."""
    DAMAGED = 'damaged'
    """Its bag is not what was recorded: the row is due again."""
    DUE = 'due'


_HOUR_S = 3600.0
OPEN = (State.DUE, State.RUNNING, State.INTERRUPTED, State.DAMAGED)
"""What is not done yet, and will be."""


@dataclass
class Run:
    """One row of the plan."""

    run_id: str
    label: str
    """Short name of its case."""
    state: State = State.DUE
    worker: str = ''
    """Namespace of who runs it, or ran it."""
    planned: int = 0
    """Episodes that it is to have; 0 while unknown."""
    returns: list[float] = field(default_factory=list)
    """Of each episode so far."""
    reward: float = math.nan
    """Mean of the last returns, over the window of the response."""
    seconds: float = 0.0
    """Wall time since its worker began it, or began it again, up to the last episode."""
    earlier: int = 0
    """Episodes that it already had then."""
    settings: Mapping[str, str] = field(default_factory=dict)
    """Its length and what is not varied of its specification, as its bag states them."""
    reason: str = ''
    """Why it failed, or how the run in its place differs from it."""

    @property
    def phase(self) -> str:
        """Its state; once a run under way has had its episodes, that it is being evaluated."""
        over = self.planned > 0 and len(self.returns) >= self.planned
        return 'evaluating' if over and self.state is State.RUNNING else self.state

    @property
    def episodes_per_second(self) -> float:
        """Rate of its worker; 0 while nothing is known."""
        return (len(self.returns) - self.earlier) / self.seconds if self.seconds > 0.0 else 0.0


@dataclass(frozen=True)
class Worker:
    """What one worker has done and does."""

    name: str
    runs: tuple[Run, ...]
    """Under way; a fleet has many at once."""
    done: int
    """Runs."""
    episodes_per_second: float


@dataclass
class Progress:
    """A campaign's rows, in the order in which they are run."""

    name: str
    runs: dict[str, Run]
    legend: tuple[str, ...] = ()
    """What the letters of the cases stand for; empty for sensors."""
    stopped: str = ''
    """How its stop rule ended it; empty if it did not."""

    @property
    def complete(self) -> bool:
        """Whether all its runs are done, or its rule has ended it and no run is under way."""
        by_rule = bool(self.stopped) and not self.having(State.RUNNING)
        return by_rule or len(self.having(State.DONE)) == len(self.runs)

    @property
    def heading(self) -> str:
        """What the names of the cases list."""
        return 'high factors' if self.legend else 'sensors'

    def having(self, *states: State) -> list[Run]:
        """Return the runs in any of these states."""
        return [run for run in self.runs.values() if run.state in states]

    @property
    def mixed(self) -> list[str]:
        """In what runs differ that should have it in common: a line for each length or value."""
        done = {run.run_id: run.settings for run in self.having(State.DONE)}
        return list(odd_runs(done).values())

    @property
    def episodes(self) -> int:
        """Episodes of runs that are not lost."""
        return sum(len(r.returns) for r in self.runs.values() if r.state is not State.FAILED)

    @property
    def planned(self) -> int:
        """Episodes of all rows; one that has not begun counts as the longest one that has."""
        longest = max((run.planned for run in self.runs.values()), default=0)
        return sum(run.planned or longest for run in self.runs.values())

    @property
    def workers(self) -> list[Worker]:
        """Everyone who has, or had, a run."""
        names = sorted({run.worker for run in self.runs.values() if run.worker})
        return [
            _worker(name, [r for r in self.runs.values() if r.worker == name]) for name in names
        ]

    @property
    def episodes_per_second(self) -> float:
        """Rate of all workers that have a run; one that is yet to end an episode has the usual."""
        rates = [w.episodes_per_second for w in self.workers if w.episodes_per_second > 0.0]
        usual = sum(rates) / len(rates) if rates else 0.0
        known = sum((w.episodes_per_second or usual for w in self.workers if w.runs), 0.0)
        return known + usual * sum(not run.worker for run in self.having(State.RUNNING))

    @property
    def seconds_left(self) -> float:
        """Expected time to the end at the present rate; NaN while nothing is known."""
        longest = max((run.planned for run in self.runs.values()), default=0)
        open_runs = self.having(*((State.RUNNING,) if self.stopped else OPEN))
        left = sum((run.planned or longest) - len(run.returns) for run in open_runs)
        if not open_runs:
            return 0.0
        rate = self.episodes_per_second
        return left / rate if rate > 0.0 and longest else math.nan

    @property
    def measured(self) -> list[Run]:
        """Finished runs whose time is known."""
        return [run for run in self.having(State.DONE) if run.seconds > 0.0 and run.planned]

    @property
    def runs_per_core_hour(self) -> float:
        """Runs that a core does in an hour, by those that are measured; NaN without one.

        A worker has one run at a time, and so has each thread of a fleet's unless told otherwise.
        """
        done = sum(1.0 - run.earlier / run.planned for run in self.measured)
        seconds = sum(run.seconds for run in self.measured)
        return done / seconds * _HOUR_S if seconds else math.nan

    @property
    def core_hours_left(self) -> float:
        """Time that what is open takes at that pace; NaN while nothing is measured."""
        left = sum(
            1.0 - len(r.returns) / r.planned if r.planned else 1.0 for r in self.having(*OPEN)
        )
        return left / self.runs_per_core_hour


def _worker(name: str, runs: Iterable[Run]) -> Worker:
    runs = list(runs)
    current = tuple(run for run in runs if run.state is State.RUNNING)
    rate = sum((run.episodes_per_second for run in current), 0.0)
    if not rate:  # its present run has no episode yet
        seconds = sum(run.seconds for run in runs)
        fresh = sum(len(run.returns) - run.earlier for run in runs)
        rate = fresh / seconds if seconds > 0.0 else 0.0
    return Worker(name, current, sum(run.state is State.DONE for run in runs), rate)


def duration(seconds: float) -> str:
    """Return a time as hours, minutes and seconds; '?' for NaN."""
    if math.isnan(seconds):
        return '?'
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f'{hours}:{minutes:02}:{rest:02}' if hours else f'{minutes}:{rest:02}'
