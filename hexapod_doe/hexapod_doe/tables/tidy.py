# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Plain tables of campaigns for other programs: a row per run, and a row per episode."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Any

import pandas as pd

from hexapod_doe.bags.run_record import RunRecord, find_bags
from hexapod_doe.designs.factor import Factor, default_factors, factors_in
from hexapod_doe.errors import TableError
from hexapod_doe.fitting.model import EMPTY_SET
from hexapod_doe.tables.bag_factors import set_of
from hexapod_doe.tables.bag_groups import Part, group_runs, sound_bags
from hexapod_doe.tables.bag_response import (
    EVALUATION_PREFIX,
    RESPONSES,
    judged_of,
    response_of,
    terms_of,
)

TRAINING, EVALUATION = 'training', 'evaluation'
DESIGN, FOLLOW_UP, CONFIRMATION = 'design', 'follow-up', 'confirmation'
_MADE_WITH = {
    'commit': 'git_commit',
    'processor': 'processor',
    'python': 'version.python',
    'numpy': 'version.numpy',
    'torch': 'version.torch',
    'mujoco': 'version.mujoco',
}
"""Columns of a run, and the key of its bag's metadata."""
_MEANINGS = {
    'campaign': 'folder of the campaign, below the folder that was exported',
    'run_id': 'name of the run, which no other run of its campaign has',
    'part': f'{DESIGN}: a row of the plan; {FOLLOW_UP}: of one that adds to it; {CONFIRMATION}: '
    'new runs of sets that were chosen, not to be fitted',
    'case': 'combination of levels, as the plan numbers them',
    'replicate': 'number of the run among those of its case',
    'run_order': 'random order in which the plan has the runs',
    'seed': 'of starts, networks and exploration noise',
    'set': f'letters of the factors at the high level; {EMPTY_SET} where there are none',
    'episodes': 'episodes of the training',
    'evaluation_return': 'mean return without noise, after the training, from starts that all '
    'runs share',
    'evaluation_falls': 'episodes of the evaluation that ended by a failure',
    'evaluation_recovered': 'share of those in which a varied robot does not fail and has half '
    'the late speed of the robot as it was built',
    'final_average_reward': 'mean of the last returns of the training, with exploration noise',
    'best_average_reward': 'highest mean of as many returns in a row',
    'final_iqm_reward': 'mean of the middle half of the last returns',
    'mean_return': 'mean of all returns of the training',
    'began': 'when the recording began, UTC',
    'seconds': 'wall time of the recording; of a run that was cut, of its last part',
    'commit': 'git commit that trained',
    'processor': 'kind of the processor, and the instructions that results depend on',
    **{name: f'version of {name}' for name in ('python', 'numpy', 'torch', 'mujoco')},
    'phase': f'{TRAINING}, or {EVALUATION} after it',
    'episode': 'number within the phase, from 0',
    'cause': 'why the episode ended: time_limit, or the failure',
    'stamp_ns': 'simulated time of the end of the episode, ns',
}


@dataclass(frozen=True)
class Tidy:
    """Tables of complete runs.

    Attributes:
        runs: A row per run: who it is, level of each factor (±1) by its letter, responses, and
            what it was made with.
        episodes: A row per episode of training and evaluation.
        columns: What the columns mean: table, column, meaning.
        notes: What was left out.
    """

    runs: pd.DataFrame
    episodes: pd.DataFrame
    columns: pd.DataFrame
    notes: tuple[str, ...]


def tidy(paths: Sequence[Path], meanings: dict[str, str]) -> Tidy:
    """Tabulate all complete runs below some folders, confirmation runs included.

    Args:
        paths: Folders of campaigns, or above some.
        meanings: What a bag has of an episode, by the name of the column.

    Raises:
        BagError: A bag cannot be read.
        TableError: There is no complete run, or a letter stands for two factors.
    """
    complete, left_out = sound_bags([bag for path in paths for bag in find_bags(path)])
    if not complete:
        raise TableError(f'{", ".join(map(str, paths))}: no bag of a complete run')
    groups, confirming, caveats = group_runs(complete)
    parts = [part for group in groups for part in group.parts] + confirming
    named = [(_campaign(part.folder, paths), part) for part in parts]
    factors = _one_meaning(named)
    runs = pd.DataFrame(
        [_run_row(name, part, run) for name, part in named for run in part.runs]
    ).sort_values(['campaign', 'run_order', 'run_id'], ignore_index=True)
    letters = [letter for letter in factors if letter in runs]
    runs[letters] = runs[letters].astype('Int64')
    episodes = pd.concat(
        [_episode_rows(name, run) for name, part in named for run in part.runs], ignore_index=True
    )
    apart = {name: text for names, text in meanings.items() for name in names.split(', ')}
    meanings = {**apart, **_MEANINGS, **{key: f.change for key, f in factors.items()}}
    tables = {'runs': runs, 'episodes': episodes}
    return Tidy(runs, episodes, _dictionary(tables, meanings), (*left_out, *caveats))


def _campaign(folder: Path, paths: Iterable[Path]) -> str:
    """Name a campaign by its way from the folder that was given, or by its own name."""
    for path in paths:
        if folder.resolve() != path.resolve() and folder.resolve().is_relative_to(path.resolve()):
            return folder.resolve().relative_to(path.resolve()).as_posix()
    return folder.resolve().name


def _factors(run: RunRecord) -> tuple[Factor, ...]:
    """Return the factors of a run; of a plan of sensors those that it states a level of."""
    found = factors_in(run.metadata)
    if found is not None:
        return tuple(found)
    return default_factors(letter for letter in 'ABCDEFG' if letter in run.metadata)


def _one_meaning(parts: Iterable[tuple[str, Part]]) -> dict[str, Factor]:
    """Return the factors by letter.

    Raises:
        TableError: A letter is one factor here, and another there.
    """
    known: dict[str, tuple[str, Factor]] = {}
    for name, part in parts:
        for run in part.runs:
            for factor in _factors(run):
                campaign, other = known.setdefault(factor.letter, (name, factor))
                if (other.key, other.low, other.high) != (factor.key, factor.low, factor.high):
                    raise TableError(
                        f'{factor.letter} is {other.change!r} in {campaign} and '
                        f'{factor.change!r} in {name}: export them apart'
                    )
    return {letter: known[letter][1] for letter in sorted(known)}


def _run_row(campaign: str, part: Part, run: RunRecord) -> dict[str, Any]:
    told = run.metadata
    return {
        'campaign': campaign,
        'run_id': run.run_id,
        'part': CONFIRMATION if part.confirms else FOLLOW_UP if part.follows else DESIGN,
        'case': _whole(told.get('case')),
        'replicate': _whole(told.get('replicate')),
        'run_order': _whole(told.get('RunOrder')),
        'seed': _whole(told.get('seed')),
        'set': ''.join(sorted(set_of(run))) or EMPTY_SET,
        **{f.letter: _whole(told.get(f.letter)) for f in _factors(run)},
        'episodes': len(run.episodes),
        **_responses(run),
        'began': told.get('recording_began', ''),
        'seconds': _seconds(told.get('recording_began', ''), told.get('recording_ended', '')),
        **{column: told.get(key, '') for column, key in _MADE_WITH.items()},
    }


def _responses(run: RunRecord) -> dict[str, float]:
    """Return all that the run may be judged by, of the evaluation where it has one."""
    names = [*RESPONSES, *terms_of(run), *judged_of(run)]
    if run.evaluation.empty:
        names = [name for name in names if not name.startswith(EVALUATION_PREFIX)]
    return {name: response_of(run, name) for name in names}


def _episode_rows(campaign: str, run: RunRecord) -> pd.DataFrame:
    phases = {TRAINING: run.episodes, EVALUATION: run.evaluation}
    return pd.concat(
        [
            table.reset_index().assign(campaign=campaign, run_id=run.run_id, phase=phase)
            for phase, table in phases.items()
            if not table.empty
        ],
        ignore_index=True,
    ).pipe(_names_first)


def _names_first(table: pd.DataFrame) -> pd.DataFrame:
    first = ['campaign', 'run_id', 'phase', 'episode']
    return table[[*first, *(column for column in table if column not in first)]]


def _dictionary(tables: dict[str, pd.DataFrame], meanings: dict[str, str]) -> pd.DataFrame:
    return pd.DataFrame(
        [
            {'table': name, 'column': column, 'meaning': _meaning(str(column), meanings)}
            for name, table in tables.items()
            for column in table
        ]
    )


def _meaning(column: str, meanings: dict[str, str]) -> str:
    if column in meanings:
        return meanings[column]
    term = column.removeprefix(EVALUATION_PREFIX)
    return f'mean over the evaluation: {meanings[term]}' if term in meanings else ''


def _whole(text: str | None) -> int | None:
    return None if text in (None, '') else int(str(text))


def _seconds(began: str, ended: str) -> float | None:
    if not began or not ended:
        return None
    return (datetime.fromisoformat(ended) - datetime.fromisoformat(began)).total_seconds()
