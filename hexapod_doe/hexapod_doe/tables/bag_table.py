# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Reads a campaign's bags into tables of runs, one per design."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import pandas as pd
from hexapod_agent.observation import CHANNELS, LETTERS

from hexapod_doe.bags.run_record import RunRecord, find_bags, is_complete, read_run
from hexapod_doe.campaigns.campaign import PLAN_FILE
from hexapod_doe.designs.plan_file import read_plan
from hexapod_doe.designs.plan_types import Confirmation, PlanSettings
from hexapod_doe.errors import BagError, TableError
from hexapod_doe.fitting.model import EMPTY_SET
from hexapod_doe.tables.bag_response import DEFAULT_RESPONSE, response_of
from hexapod_doe.tables.table import (
    BLOCK,
    RESPONSE,
    TERM_PREFIX,
    RunTable,
    block_fault,
    build_rows,
)

_DESIGN_ROW = ('case', 'replicate', 'RunOrder')


@dataclass
class _Group:
    """Bags of one design."""

    title: str
    design: str
    blocks: str
    bags: list[Path] = field(default_factory=list)


def read_bags(
    paths: Sequence[Path],
    factors: Sequence[str] | None = None,
    response: str = DEFAULT_RESPONSE,
    blocks: str | None = None,
) -> list[RunTable]:
    """Read all complete bags below some directories; each campaign is one table.

    A campaign that follows another one (a foldover, added cases) joins it.

    Args:
        paths: Directories of campaigns or bags.
        factors: Letters of the observations that may be on; by default all.
        response: What a run is judged by, see `bag_response`.
        blocks: Key of the metadata that tells the blocks apart, such as `seed`; empty for none,
            None for what the campaign's plan says, if there are two or more yet.

    Raises:
        BagError: A directory is missing, a bag cannot be read or its metadata lack a key.
        AnalysisError: There is no complete bag or no such response, or the runs cannot be
            analysed.
    """
    bags = [bag for path in paths for bag in find_bags(path)]
    complete = [bag for bag in bags if is_complete(bag)]
    if not complete:
        raise TableError(f'{_names(paths)}: {len(bags)} bags, none of a complete run')
    skipped = len(bags) - len(complete)
    caveats = (f'{skipped} bags of unfinished runs are left out.',) if skipped else ()
    names = tuple(factors or LETTERS)
    source = _names(paths)
    return [_table(group, source, caveats, names, response, blocks) for group in _groups(complete)]


def plan_rule(paths: Sequence[Path]) -> Confirmation:
    """Return the confirmation rule of the first campaign's plan, or the default one."""
    for path in paths:
        settings = _settings(path)
        if settings is not None:
            return settings.confirmation
    return Confirmation()


def bag_responses(path: Path, response: str = DEFAULT_RESPONSE) -> dict[str, list[float]]:
    """Return the responses of the complete runs below a directory, by their observations."""
    responses: dict[str, list[float]] = {}
    for bag in filter(is_complete, find_bags(path)):
        run = read_run(bag)
        label = ''.join(sorted(_known(run, 'observations'))) or EMPTY_SET
        responses.setdefault(label, []).append(response_of(run, response))
    return responses


def _names(paths: Iterable[Path]) -> str:
    return ', '.join(map(str, paths))


def _campaign(bag: Path) -> Path | None:
    """Return the campaign's directory: the nearest one above a bag that holds a plan."""
    return next((parent for parent in bag.parents if (parent / PLAN_FILE).is_file()), None)


def _settings(campaign: Path | None) -> PlanSettings | None:
    if campaign is None or not (campaign / PLAN_FILE).is_file():
        return None
    return read_plan(campaign / PLAN_FILE).settings


def _groups(bags: Iterable[Path]) -> list[_Group]:
    by_campaign: dict[Path | None, list[Path]] = {}
    for bag in bags:
        by_campaign.setdefault(_campaign(bag.resolve()), []).append(bag)
    groups: list[_Group] = []
    for campaign, found in by_campaign.items():
        settings = _settings(campaign)
        if settings is None or not settings.follows or not groups:
            title = campaign.name if campaign else found[0].parent.resolve().name
            design, blocks = (settings.design, settings.block_column) if settings else ('', '')
            groups.append(_Group(title, design, blocks))
        elif settings is not None:
            groups[-1].design = settings.design
        groups[-1].bags += found
    return groups


def _table(
    group: _Group,
    source: str,
    caveats: tuple[str, ...],
    factors: tuple[str, ...],
    response: str,
    blocks: str | None,
) -> RunTable:
    runs = [read_run(bag) for bag in group.bags]
    blocks = _planned_blocks(group, runs) if blocks is None else blocks
    raw = pd.DataFrame([_row(run, factors, response, blocks) for run in runs])
    rows, found = build_rows(raw.dropna(axis=1), factors)
    return RunTable(
        title=group.title,
        source=source,
        response=response,
        factors=factors,
        rows=rows,
        caveats=(*caveats, *found),
        design=group.design,
        block_column=blocks,
        factor_names={channel.letter: channel.name for channel in CHANNELS if channel.letter},
        curves=_curves(runs, rows),
    )


def _planned_blocks(group: _Group, runs: Sequence[RunRecord]) -> str:
    """Return what the plan blocks the runs by, as far as those that there are allow it."""
    sets = pd.Series([_known(run, 'observations') for run in runs])
    block = pd.Series([run.metadata.get(group.blocks) for run in runs], dtype=object)
    return '' if block_fault(sets, block) else group.blocks


def _row(run: RunRecord, factors: Sequence[str], response: str, blocks: str) -> dict[str, object]:
    letters = _known(run, 'observations')
    return {
        'run_id': run.run_id,
        **{name: int(run.metadata[name]) for name in _DESIGN_ROW if run.metadata.get(name)},
        **{factor: 1 if factor in letters else -1 for factor in factors},
        RESPONSE: response_of(run, response),
        **({BLOCK: _known(run, blocks)} if blocks else {}),
    }


def _known(run: RunRecord, key: str) -> str:
    if key not in run.metadata:
        raise BagError(f'run {run.run_id}: its metadata lacks the key {key!r}')
    return run.metadata[key]


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
