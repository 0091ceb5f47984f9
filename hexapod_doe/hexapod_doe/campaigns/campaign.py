# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Which rows of a plan are done, running and due. The bags are the record: nothing else is."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from hexapod_doe.bags.run_record import is_complete
from hexapod_doe.designs.plan_file import read_plan

PLAN_FILE = 'plan.csv'
RUNS_FOLDER = 'runs'


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

    @classmethod
    def open(cls, plan: Path, attempts: int = 3) -> Campaign:
        """Read a plan and find out from the bags beside it which rows are done.

        Raises:
            FileNotFoundError: there is no such plan.
            hexapod_doe.designs.plan_file.PlanError: the file is not a plan.
        """
        directory = plan.resolve().parent
        table = read_plan(plan).rows.sort_values('RunOrder')
        rows = tuple(
            Row(
                run_id=row['run_id'],
                observations=row['observations'],
                seed=int(row['seed']),
                bag=directory / RUNS_FOLDER / row['run_id'],
                metadata={str(key): str(value) for key, value in row.items()},
            )
            for row in table.to_dict('records')
        )
        campaign = cls(directory, rows, attempts)
        campaign.done = {row.run_id for row in rows if is_complete(row.bag)}
        return campaign

    @property
    def failed(self) -> list[str]:
        """Runs that were tried as often as allowed."""
        return [run_id for run_id, why in self.reasons.items() if len(why) >= self.attempts]

    @property
    def finished(self) -> bool:
        """Whether no row is due or running."""
        return not self.running and self._due() is None

    def take(self, worker: str) -> Row | None:
        """Give the next row that is due to a worker."""
        row = self._due()
        if row is not None:
            self.running[row.run_id] = worker
        return row

    def complete(self, row: Row) -> bool:
        """Count a row as done if its bag is whole; return whether it is."""
        if not is_complete(row.bag):
            self.fail(row, f'bag {row.bag} is not complete')
            return False
        self.running.pop(row.run_id, None)
        self.done.add(row.run_id)
        return True

    def fail(self, row: Row, reason: str) -> None:
        """Note a failed try; the row is due again unless it was the last one."""
        self.running.pop(row.run_id, None)
        self.reasons.setdefault(row.run_id, []).append(reason)

    def release(self, row: Row) -> None:
        """Take a row back from a worker that is gone, through no fault of the row."""
        self.running.pop(row.run_id, None)

    def _due(self) -> Row | None:
        gone = {*self.done, *self.running, *self.failed}
        return next((row for row in self.rows if row.run_id not in gone), None)
