# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Keeps a plan from being written over the runs of another one."""

from collections.abc import Sequence
from pathlib import Path

from hexapod_doe.campaigns.campaign_lock import ROW_SUFFIX
from hexapod_doe.campaigns.row import RUNS_FOLDER, Row, rows_of
from hexapod_doe.designs.plan_file import PlanError, read_plan
from hexapod_doe.designs.plan_types import Plan


def check_free(plan: Plan, out: Path) -> None:
    """Make sure that a plan may be written to a file, as none of its runs would be lost or taken.

    The same plan may be written again at any time.

    Raises:
        PlanError: there is another plan with runs, or runs that are not this plan's lie where its
            own would.
    """
    directory = out.resolve().parent
    rows = rows_of(plan, directory)
    old = _rows_of_file(out)
    begun = [row.run_id for row in (rows if old is None else old) if has_begun(row)]
    if old is not None and begun and _alike(old) != _alike(rows):
        raise PlanError(
            f'{out}: a plan with runs ({_count(begun)} in {directory / RUNS_FOLDER}), expected '
            'none; give --out in a folder of its own, or remove plan and runs first'
        )
    others = {row.run_id: state.other for row in rows if (state := row.bag_state()).other}
    if others:
        run_id, why = next(iter(others.items()))
        raise PlanError(
            f'{out}: {_count(list(others))} in {directory / RUNS_FOLDER} are of another plan '
            f'({run_id}: {why}), expected none; give --out in a folder of its own, or remove them'
        )


def has_begun(row: Row) -> bool:
    """Whether anything of a row's run lies in the campaign's folder."""
    traces = row.bag.parent.glob(f'{row.bag.name}.*')
    return row.bag.exists() or any(trace.suffix != ROW_SUFFIX for trace in traces)


def _rows_of_file(path: Path) -> tuple[Row, ...] | None:
    """Return the rows of a plan that is there; None where none can be read."""
    try:
        return rows_of(read_plan(path), path.resolve().parent)
    except (FileNotFoundError, PlanError):
        return None


def _alike(rows: Sequence[Row]) -> list[tuple[object, ...]]:
    return [(dict(row.metadata), row.treatments) for row in rows]


def _count(run_ids: Sequence[str]) -> str:
    return f'{len(run_ids)} run{"s" if len(run_ids) > 1 else ""}'
