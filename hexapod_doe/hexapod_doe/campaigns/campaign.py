# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Which rows of a plan are done, running and due. The bags are the record: nothing else is."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from hexapod_doe.bags.run_record import is_complete
from hexapod_doe.designs.plan_file import read_plan
from hexapod_doe.errors import CampaignError

PLAN_FILE = 'plan.csv'
RUNS_FOLDER = 'runs'
_PROBE_BYTES = 1 << 20


@dataclass(frozen=True)
class Row:
    """One training run of the plan."""

    run_id: str
    observations: str
    seed: int
    bag: Path
    """Directory of the run's bag, complete or not yet there."""
    metadata: Mapping[str, str]
    """Every column of the row, for the bag."""


def read_rows(plan: Path) -> tuple[Row, ...]:
    """Read the rows of a plan in its run order; their bags are to lie beside it.

    Raises:
        FileNotFoundError: there is no such plan.
        hexapod_doe.designs.plan_file.PlanError: the file is not a plan.
    """
    directory = plan.resolve().parent
    table = read_plan(plan).rows.sort_values('RunOrder')
    return tuple(
        Row(
            run_id=row['run_id'],
            observations=row['observations'],
            seed=int(row['seed']),
            bag=directory / RUNS_FOLDER / row['run_id'],
            metadata={str(key): str(value) for key, value in row.items()},
        )
        for row in table.to_dict('records')
    )


@dataclass(frozen=True)
class RunSettings:
    """What all runs of a campaign have in common."""

    episodes: int
    """Length of a training."""
    config: str = ''
    """Hyper-parameter file on the workers; empty for theirs."""
    record_every: int = 0
    """Every how many episodes all topics are recorded; 0 for never."""


@dataclass
class Campaign:
    """The state of a plan's rows.

    Rows go out in the plan's run order. A row is done when its bag is closed and whole.
    """

    directory: Path
    rows: tuple[Row, ...]
    attempts: int = 3
    """How often a row may be tried before it counts as failed."""
    done: set[str] = field(default_factory=set)
    running: dict[str, str] = field(default_factory=dict)
    """Worker by run id."""
    reasons: dict[str, list[str]] = field(default_factory=dict)
    """Why each try of a run failed, by run id."""
    tried: dict[str, set[str]] = field(default_factory=dict)
    """Workers on which a run failed or got stuck, by run id."""

    @classmethod
    def open(cls, plan: Path, attempts: int = 3) -> Campaign:
        """Read a plan and find out from the bags beside it which rows are done.

        Raises:
            FileNotFoundError: there is no such plan.
            hexapod_doe.designs.plan_file.PlanError: the file is not a plan.
        """
        rows = read_rows(plan)
        campaign = cls(plan.resolve().parent, rows, attempts)
        campaign.done = {row.run_id for row in rows if is_complete(row.bag)}
        return campaign

    @property
    def failed(self) -> list[str]:
        """Runs that were tried as often as allowed."""
        return [run_id for run_id, why in self.reasons.items() if len(why) >= self.attempts]

    @property
    def finished(self) -> bool:
        """Whether no row is due or running."""
        return not self.running and len({*self.done, *self.failed}) == len(self.rows)

    def take(self, worker: str, present: Collection[str] = ()) -> Row | None:
        """Give the next row that is due to a worker.

        A row that failed on a worker goes to another one, if there is one that has not tried it.

        Args:
            worker: by name.
            present: all workers that there are.
        """
        gone = {*self.done, *self.running, *self.failed}
        for row in self.rows:
            tried = self.tried.get(row.run_id, set())
            if row.run_id in gone or (worker in tried and not tried.issuperset(present)):
                continue
            if is_complete(row.bag):  # by somebody who was given up
                self.done.add(row.run_id)
                continue
            self.running[row.run_id] = worker
            return row
        return None

    def complete(self, row: Row, reason: str = '') -> bool:
        """Count a row as done if its bag is whole; return whether it is.

        Args:
            row: whose run has ended.
            reason: why it failed if the bag is not whole, where something is known.
        """
        if not is_complete(row.bag):
            self.fail(row, reason or f'bag {row.bag} is not complete')
            return False
        self.running.pop(row.run_id, None)
        self.done.add(row.run_id)
        return True

    def fail(self, row: Row, reason: str) -> None:
        """Note a failed try; the row is due again unless it was the last one."""
        worker = self.running.pop(row.run_id, None)
        if worker is not None:
            self.tried.setdefault(row.run_id, set()).add(worker)
        self.reasons.setdefault(row.run_id, []).append(reason)

    def release(self, row: Row, tried: bool = False) -> None:
        """Take a row back from a worker, through no fault of the row.

        Args:
            row: that is due again.
            tried: whether the worker was at fault, so that another should have the row next.
        """
        worker = self.running.pop(row.run_id, None)
        if tried and worker is not None:
            self.tried.setdefault(row.run_id, set()).add(worker)

    def check_writable(self) -> None:
        """Make sure that the folder takes what a run would write.

        Raises:
            CampaignError: it does not; the text says why.
        """
        runs = self.directory / RUNS_FOLDER
        try:
            runs.mkdir(exist_ok=True)
            with tempfile.TemporaryFile(dir=runs) as probe:
                probe.write(bytes(_PROBE_BYTES))
                probe.flush()
                os.fsync(probe.fileno())
        except OSError as error:
            raise CampaignError(
                f'campaign {self.directory}: cannot write: {error.strerror}; what is done stays '
                'done, start the same command again when that is put right'
            ) from error
