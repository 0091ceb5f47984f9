# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Which rows of a plan are done, running and due. The bags are the record: nothing else is."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Collection
from dataclasses import dataclass, field
from pathlib import Path

from hexapod_agent.specification.run_spec import RunSpec

from hexapod_doe.bags.cuts import forget_cuts_of_closed
from hexapod_doe.campaigns.changes import Changes
from hexapod_doe.campaigns.row import RUNS_FOLDER, Row, read_rows
from hexapod_doe.campaigns.stop_rule import stopped_text
from hexapod_doe.errors import CampaignError

PLAN_FILE = 'plan.csv'
_PROBE_BYTES = 1 << 20
_NAMED = 8
"""Rows that a message names."""


@dataclass
class Campaign:
    """The state of a plan's rows.

    Rows go out in the plan's run order. A row is done when its bag is closed, whole and its own.
    """

    directory: Path
    rows: tuple[Row, ...]
    attempts: int = 3
    """How often a row may be tried before it counts as failed."""
    known: bool = False
    """Whether the specifications of the rows are those of their runs; else the plan alone is."""
    done: set[str] = field(default_factory=set)
    running: dict[str, str] = field(default_factory=dict)
    """Worker by run id."""
    reasons: dict[str, list[str]] = field(default_factory=dict)
    """Why each try of a run failed, by run id."""
    others: dict[str, str] = field(default_factory=dict)
    """Rows at whose place there is the whole bag of another run, and how that differs."""
    damaged: dict[str, str] = field(default_factory=dict)
    """Rows whose bag was damaged when the campaign was opened, and how; they are due again."""
    stopped: str = ''
    """How its stop rule ended it; empty if it did not."""
    tried: dict[str, set[str]] = field(default_factory=dict)
    """Workers on which a run failed or got stuck, by run id."""

    @classmethod
    def open(cls, plan: Path, attempts: int = 3, changes: Changes | None = None) -> Campaign:
        """Read a plan and find out from the bags beside it which rows are done.

        Args:
            plan: its file.
            attempts: how often a row may be tried.
            changes: to the specification that its runs start from; None where they are not known.

        Raises:
            FileNotFoundError: there is no such plan.
            hexapod_doe.designs.plan_file.PlanError: the file is not a plan.
            hexapod_agent.specification.run_spec.ConfigError: it cannot be changed so.
            ValueError: what its folder holds of its stop rule is no such record.
        """
        rows = read_rows(plan, changes)
        campaign = cls(plan.resolve().parent, rows, attempts, changes is not None)
        campaign.stopped = stopped_text(campaign.directory)
        states = {row.run_id: row.bag_state(campaign.known) for row in rows}
        campaign.done = {run_id for run_id, state in states.items() if state.done}
        campaign.others = {run_id: state.other for run_id, state in states.items() if state.other}
        campaign.damaged = {
            run_id: state.damage for run_id, state in states.items() if state.damage
        }
        return campaign

    @property
    def base(self) -> RunSpec:
        """The specification that all rows start from."""
        return self.rows[0].treatments.base

    @property
    def legend(self) -> tuple[str, ...]:
        """What the letters of the factors stand for; empty for sensors."""
        return self.rows[0].treatments.legend

    @property
    def due(self) -> list[Row]:
        """Rows that are not done."""
        return [row for row in self.rows if row.run_id not in self.done]

    def check_own(self) -> None:
        """Make sure that no row's place is taken by the bag of another run.

        Raises:
            CampaignError: one is; the text names the rows and the cure.
        """
        if not self.others:
            return
        named = list(self.others.items())[:_NAMED]
        more = f' and {len(self.others) - _NAMED} more' if len(self.others) > _NAMED else ''
        raise CampaignError(
            f'campaign {self.directory}: {len(self.others)} of {len(self.rows)} rows have the bag '
            f'of another run: {"; ".join(f"{run_id} ({why})" for run_id, why in named)}{more}; '
            'give the options that they were made with, use a folder of its own, or move these '
            f'bags out of {self.directory / RUNS_FOLDER} to have the rows trained anew'
        )

    def forget_cuts(self) -> None:
        """Remove recordings that were cut of rows that are done, where that was prevented."""
        for row in self.rows:
            if row.run_id in self.done:
                forget_cuts_of_closed(row.bag)

    @property
    def failed(self) -> list[str]:
        """Runs that were tried as often as allowed."""
        return [run_id for run_id, why in self.reasons.items() if len(why) >= self.attempts]

    @property
    def finished(self) -> bool:
        """Whether no row is running, and none is due or its rule has ended it."""
        every = len({*self.done, *self.failed}) == len(self.rows)
        return not self.running and (every or bool(self.stopped))

    @property
    def over(self) -> bool:
        """Whether every row is done, or the rule has ended it."""
        return bool(self.stopped) or len(self.done) == len(self.rows)

    def take(
        self, worker: str, present: Collection[str] = (), among: Collection[str] | None = None
    ) -> Row | None:
        """Give the next row that is due to a worker.

        A row that failed on a worker goes to another one, if there is one that has not tried it.

        Args:
            worker: by name.
            present: all workers that there are.
            among: run ids of the rows that it can take; None for all.
        """
        if self.stopped:
            return None
        gone = {*self.done, *self.running, *self.failed}
        if among is not None:
            gone |= {row.run_id for row in self.rows} - set(among)
        for row in self.rows:
            tried = self.tried.get(row.run_id, set())
            if row.run_id in gone or (worker in tried and not tried.issuperset(present)):
                continue
            if self.has_bag(row):  # by somebody who was given up
                self.done.add(row.run_id)
                continue
            self.running[row.run_id] = worker
            return row
        return None

    def has_bag(self, row: Row) -> bool:
        """Whether a row has its bag, whoever made it."""
        return row.bag_state(self.known).done

    def complete(self, row: Row, reason: str = '') -> bool:
        """Count a row as done if its bag is whole and its own; return whether it is.

        Args:
            row: whose run has ended.
            reason: why it failed if the bag is not whole, where something is known.
        """
        state = row.bag_state(self.known)
        if state.other:
            self.fail(row, f'bag {row.bag} is of another run: {state.other}')
            return False
        if not state.whole:
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
