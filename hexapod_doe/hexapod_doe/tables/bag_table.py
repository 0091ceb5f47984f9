# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Reads a campaign's bags into tables of runs, one per design."""

import hashlib
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

import pandas as pd

from hexapod_doe.bags.run_identity import CONFIG, differences, making, odd_runs
from hexapod_doe.bags.run_record import RunRecord, find_bags, is_complete, read_run
from hexapod_doe.campaigns.campaign import PLAN_FILE
from hexapod_doe.designs.factor import Factor
from hexapod_doe.designs.plan_file import read_plan
from hexapod_doe.designs.plan_types import Confirmation
from hexapod_doe.errors import BagError, TableError
from hexapod_doe.fitting.model import EMPTY_SET
from hexapod_doe.tables.bag_factors import factors_of, known, set_of, shared_settings
from hexapod_doe.tables.bag_groups import Group, Part, group_runs, sound_bags
from hexapod_doe.tables.bag_response import default_response, response_of
from hexapod_doe.tables.table import (
    BLOCK,
    RESPONSE,
    TERM_PREFIX,
    RunTable,
    block_fault,
    build_rows,
)

_DESIGN_ROW = ('case', 'replicate')
_NAMED = 3
"""Keys in which runs differ that a message names."""


def read_bags(
    paths: Sequence[Path],
    factors: Sequence[str] | None = None,
    response: str | None = None,
    blocks: str | None = None,
) -> list[RunTable]:
    """Read all complete bags below some directories; each campaign is one table.

    A campaign that follows another one (a foldover, added cases) joins it, whichever comes first.
    Runs of a plan that confirms a choice are in no table, see `confirmation_runs`.

    Args:
        paths: Directories of campaigns or bags.
        factors: Letters of the factors to analyse; by default those of the plan, or all sensors.
        response: What a run is judged by, see `bag_response`; None for the evaluation, or what
            the article judges by where no run has one.
        blocks: Key of the metadata that tells the blocks apart, such as `seed`; empty for none,
            None for what the campaign's plan says, if there are two or more yet.

    Raises:
        BagError: A directory is missing, a bag cannot be read or its metadata lack a key.
        AnalysisError: There is no complete bag or no such response, the runs differ in length or
            configuration, or they cannot be analysed.
    """
    bags = [bag for path in paths for bag in find_bags(path)]
    complete, skipped = sound_bags(bags)
    source = ', '.join(map(str, paths))
    if not complete:
        raise TableError(
            ' '.join([f'{source}: {len(bags)} bags, none of a complete run', *skipped])
        )
    groups, confirming, found = group_runs(complete)
    if not groups and confirming:
        raise TableError(
            f'{source}: runs that confirm a choice; give the folder of the campaign that was '
            'chosen from, and these with --confirm'
        )
    if not groups:
        raise TableError(f'{source}: no run to analyse. {" ".join(found)}')
    runs = [run for group in groups for run in group.runs]
    response = default_response(runs) if response is None else response
    return [
        _table(group, source, (*skipped, *found), factors_of(group, factors), response, blocks)
        for group in groups
    ]


def plan_rule(paths: Sequence[Path]) -> Confirmation:
    """Return the confirmation rule of the first campaign's plan, or the default one."""
    for path in paths:
        plan = path / PLAN_FILE
        found = read_plan(plan).settings if plan.is_file() else None
        if found is not None:
            return found.confirmation
    return Confirmation()


def bag_responses(
    path: Path, response: str, like: Mapping[str, str] | None = None
) -> dict[str, list[float]]:
    """Return the responses of the complete runs below a directory, by their observations.

    Args:
        path: Directory of a campaign or of bags.
        response: What a run is judged by, see `bag_response`.
        like: Length and configuration that the runs must have; anything if None.

    Raises:
        BagError: A bag cannot be read, or its run has another length or configuration.
    """
    return _responses(
        (read_run(bag) for bag in find_bags(path) if is_complete(bag)), response, like
    )


def confirmation_runs(
    paths: Sequence[Path], response: str, like: Mapping[str, str] | None = None
) -> dict[str, list[float]]:
    """Return the responses of runs below some directories whose plan confirms a choice.

    A set with runs yet to come is left out.

    Raises:
        BagError: A bag cannot be read, or its run has another length or configuration.
    """
    complete = [bag for path in paths for bag in find_bags(path) if is_complete(bag)]
    runs = [run for part in group_runs(complete)[1] for run in _whole_sets(part)]
    return _responses(runs, response, like)


def _whole_sets(part: Part) -> list[RunRecord]:
    """Return the runs of the sets of which every row is done."""
    assert part.plan is not None  # it confirms
    lacking = set(part.plan.rows['run_id']) - {run.run_id for run in part.runs}
    cases = part.plan.rows.set_index('run_id')['case']
    open_cases = {cases[run_id] for run_id in lacking}
    return [run for run in part.runs if cases.get(run.run_id) not in open_cases]


def _responses(
    runs: Iterable[RunRecord], response: str, like: Mapping[str, str] | None
) -> dict[str, list[float]]:
    responses: dict[str, list[float]] = {}
    for run in runs:
        if odd := differences(shared_settings(run), like or {}):
            raise BagError(f'run {run.run_id} is not like the runs that it is to confirm: {odd}')
        label = ''.join(sorted(set_of(run))) or EMPTY_SET
        responses.setdefault(label, []).append(response_of(run, response))
    return responses


def _table(
    group: Group,
    source: str,
    caveats: tuple[str, ...],
    factors: tuple[Factor, ...],
    response: str,
    blocks: str | None,
) -> RunTable:
    runs = group.runs
    blocks = _planned_blocks(group) if blocks is None else blocks
    letters = tuple(factor.letter for factor in factors)
    raw = pd.DataFrame(_rows(group, letters, response, blocks))
    made = _check_alike(group, blocks)
    rows, found = build_rows(raw.dropna(axis=1), letters)
    return RunTable(
        title=group.title,
        source=source,
        response=response,
        factors=letters,
        rows=rows,
        caveats=(*caveats, *made, *found),
        design=group.settings.design if group.settings else '',
        block_column=blocks,
        named=factors,
        curves=_curves(runs, rows),
        settings=shared_settings(runs[0]),
    )


def _check_alike(group: Group, blocks: str) -> tuple[str, ...]:
    """Return a caveat on what some runs were made with, where that differs.

    Raises:
        TableError: Runs differ in length or configuration, and it is not taken for a block.
    """
    odd = odd_runs({run.run_id: shared_settings(run) for run in group.runs}, without=[blocks])
    if odd:
        more = [f'and {len(odd) - _NAMED} more'] if len(odd) > _NAMED else []
        told = '; '.join([*list(odd.values())[:_NAMED], *more])
        key = next(iter(odd)).split('.')[0]
        raise TableError(
            f'{group.title}: its runs are not alike ({told}), '
            'expected one length and configuration; give the bags of those that are, or take the '
            f'difference as one between blocks with --blocks {key}'
        )
    made = odd_runs({run.run_id: making(run.metadata) for run in group.runs}, without=[blocks])
    if not made:
        return ()
    return (
        f'Runs were not made with the same: {"; ".join(made.values())}. Equal seeds then give '
        'results that differ by chance.',
    )


def _planned_blocks(group: Group) -> str:
    """Return what the plan blocks the runs by, as far as those that there are allow it."""
    column = group.settings.block_column if group.settings else ''
    if not column:
        return ''
    sets = pd.Series([set_of(run) for run in group.runs])
    block = pd.Series(_blocks(group, column), dtype=object)
    return '' if block_fault(sets, block) else column


def _blocks(group: Group, column: str) -> list[str | None]:
    """Return the block of each run; those of plans that follow one another number on."""
    if column != BLOCK or len(group.parts) == 1:
        return [_block(run, column) for part in group.parts for run in part.runs]
    return [
        f'{number}.{run.metadata.get(BLOCK, 1)}'
        for number, part in enumerate(group.parts, start=1)
        for run in part.runs
    ]


def _block(run: RunRecord, column: str) -> str | None:
    if column != CONFIG:
        return run.metadata.get(column)
    found = [each for each in sorted(shared_settings(run).items()) if each[0].startswith(CONFIG)]
    # A name for many values.
    return hashlib.sha256(repr(found).encode()).hexdigest()[:8] if found else None


def _rows(
    group: Group, factors: Sequence[str], response: str, blocks: str
) -> list[dict[str, object]]:
    """Return a row for each run; plans that follow one another go on in run order and cases."""
    runs = group.runs
    labels = _blocks(group, blocks) if blocks else [None] * len(runs)
    if blocks and None in labels:
        known(runs[labels.index(None)], blocks)
    # Two plans that add to one number their cases alike: then the levels tell the cases.
    numbers = _DESIGN_ROW[1:] if any('/' in run.run_id for run in runs) else _DESIGN_ROW
    rows: list[dict[str, object]] = []
    begun = 0
    for part in group.parts:
        own = [
            _row(run, factors, response, numbers) for run in runs[len(rows) :][: len(part.runs)]
        ]
        orders = [int(run.metadata.get('RunOrder', 0)) for run in part.runs]
        rows += [
            row | ({'RunOrder': begun + order} if order else {})
            for row, order in zip(own, orders, strict=True)
        ]
        begun += max(orders, default=0)
    return [
        row | ({BLOCK: name} if blocks else {}) for row, name in zip(rows, labels, strict=True)
    ]


def _row(
    run: RunRecord, factors: Sequence[str], response: str, numbers: Sequence[str]
) -> dict[str, object]:
    letters = set_of(run)
    return {
        'run_id': run.run_id,
        **{name: int(run.metadata[name]) for name in numbers if run.metadata.get(name)},
        **{factor: 1 if factor in letters else -1 for factor in factors},
        RESPONSE: response_of(run, response),
    }


def _curves(runs: Iterable[RunRecord], rows: pd.DataFrame) -> pd.DataFrame:
    """Return the learning curves of the runs and of their reward terms, in the rows' order."""
    episodes = {run.run_id: run.episodes for run in runs}
    parts = [
        pd.DataFrame(
            {
                'run_id': row['run_id'],
                'label': row['label'],
                'case': row['case'],
                'replicate': row['replicate'],
                'episode': episodes[row['run_id']].index.to_numpy(),
                'return': episodes[row['run_id']]['episode_return'].to_numpy(float),
                'average': episodes[row['run_id']]['average_return'].to_numpy(float),
            }
        ).join(episodes[row['run_id']].filter(like=TERM_PREFIX).reset_index(drop=True))
        for row in rows.to_dict('records')
    ]
    return pd.concat(parts, ignore_index=True)
