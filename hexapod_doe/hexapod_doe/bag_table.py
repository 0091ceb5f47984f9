# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Reads a campaign's bags into tables of runs, one per design."""

from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np
import pandas as pd
from hexapod_agent.observation import CHANNELS, LETTERS

from hexapod_doe.bag import RunRecord, find_bags, is_complete, read_run
from hexapod_doe.errors import BagError
from hexapod_doe.table import CURVE_COLUMNS, RESPONSE, RunTable, TableError, build_rows

RESPONSE_NAME = 'final_average_reward'
_DESIGN_ROW = ('case', 'replicate', 'RunOrder')


def read_bags(paths: Sequence[Path], factors: Sequence[str] | None = None) -> list[RunTable]:
    """Read all complete bags below some directories; each design of a campaign is one table.

    The response is the mean of the last `window` episode returns, as the last episode's
    `average_return` holds it.

    Raises:
        BagError: A directory is missing or a bag cannot be read.
        TableError: There is no complete bag, or the runs cannot be analysed.
    """
    found = [bag for path in paths for bag in find_bags(path)]
    complete = [bag for bag in found if is_complete(bag)]
    if not complete:
        where = ', '.join(map(str, paths))
        raise TableError(f'{where}: {len(found)} bags, none of a complete run')
    skipped = len(found) - len(complete)
    caveats = (f'{skipped} bags of unfinished runs are left out.',) if skipped else ()
    runs = [read_run(bag) for bag in complete]
    source = ', '.join(map(str, paths))
    title = paths[0].resolve().name
    return [
        _table(f'{title} {design}'.strip(), source, design, group, caveats, factors)
        for design, group in _by_design(runs).items()
    ]


def _by_design(runs: Iterable[RunRecord]) -> dict[str, list[RunRecord]]:
    groups: dict[str, list[RunRecord]] = {}
    for run in runs:
        groups.setdefault(run.metadata.get('design', ''), []).append(run)
    return groups


def _table(
    title: str,
    source: str,
    design: str,
    runs: Sequence[RunRecord],
    caveats: tuple[str, ...],
    factors: Sequence[str] | None,
) -> RunTable:
    names = tuple(factors or LETTERS)
    raw = pd.DataFrame([_row(run, names) for run in runs])
    rows, found = build_rows(raw.dropna(axis=1, how='all'), names)
    return RunTable(
        title=title,
        source=source,
        response=RESPONSE_NAME,
        factors=names,
        rows=rows,
        caveats=(*caveats, *found),
        design=design,
        factor_names={channel.letter: channel.name for channel in CHANNELS if channel.letter},
        curves=_curves(runs, rows),
    )


def _row(run: RunRecord, factors: Sequence[str]) -> dict[str, object]:
    if 'observations' not in run.metadata:
        raise BagError(f'run {run.run_id}: its metadata lacks observations')
    letters = run.metadata['observations']
    return {
        'run_id': run.run_id,
        **{name: int(run.metadata[name]) for name in _DESIGN_ROW if run.metadata.get(name)},
        **{factor: 1 if factor in letters else -1 for factor in factors},
        RESPONSE: float(run.episodes['average_return'].iloc[-1]),
    }


def _curves(runs: Iterable[RunRecord], rows: pd.DataFrame) -> pd.DataFrame:
    """Return the learning curves of the runs, in the order of the rows."""
    episodes = {run.run_id: run.episodes for run in runs}
    parts = []
    for row in rows.itertuples():
        part = episodes[str(row.run_id)]
        curve = pd.DataFrame(
            {
                'run_id': row.run_id,
                'label': row.label,
                'case': row.case,
                'replicate': row.replicate,
                'episode': part.index.to_numpy(),
                'return': part['episode_return'].to_numpy(float),
                'average': part['average_return'].to_numpy(float),
            }
        )
        parts.append(curve)
    return pd.concat(parts, ignore_index=True)[list(CURVE_COLUMNS)]


def final_rewards(paths: Sequence[Path]) -> dict[str, np.ndarray]:
    """Return the responses of the runs below some directories, by their set of observations."""
    tables: dict[str, list[float]] = {}
    for path in paths:
        for bag in find_bags(path):
            run = read_run(bag)
            letters = ''.join(sorted(run.metadata['observations']))
            tables.setdefault(letters, []).append(float(run.episodes['average_return'].iloc[-1]))
    return {label: np.array(values) for label, values in tables.items()}
