# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Reads tables of runs from CSV files."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from hexapod_doe.fitting.model import labels
from hexapod_doe.tables.table import BLOCK, RESPONSE, RunTable, TableError, build_rows

DESIGN_COLUMN = 'design'
_KNOWN = ('run_id', 'case', 'StdOrder', 'replicate', 'RunOrder')


def read_csv(
    path: Path,
    response: str,
    factors: Sequence[str] | None = None,
    blocks: str = '',
) -> list[RunTable]:
    """Read a CSV file with a header; a column `design` splits it into several tables.

    Args:
        path: The file.
        response: Name of the response column.
        factors: One-character factor columns; by default all columns named by one capital letter.
        blocks: Column that tells the blocks apart; empty for none.

    Raises:
        TableError: The file has no such column, or its rows cannot be analysed.
        FileNotFoundError: There is no such file.
    """
    raw = _read(path)
    names = _factors(raw, path, response, factors)
    columns = [*names, *(name for name in _KNOWN if name in raw.columns)]
    tidy = raw[columns].assign(**{RESPONSE: raw[response]})
    if blocks:
        tidy[BLOCK] = _column(raw, path, blocks, 'blocks')
    if DESIGN_COLUMN in raw.columns and response != DESIGN_COLUMN:
        groups = [(str(name), part) for name, part in tidy.groupby(raw[DESIGN_COLUMN], sort=False)]
    else:
        groups = [('', tidy)]
    return [
        _table(path, response, names, name, blocks, part.reset_index(drop=True))
        for name, part in groups
    ]


def _read(path: Path) -> pd.DataFrame:
    try:
        return pd.read_csv(path)
    except pd.errors.EmptyDataError:
        raise TableError(f'{path}: empty file, expected a header and one row per run') from None
    except pd.errors.ParserError as error:
        raise TableError(f'{path}: {error}') from error


def _column(raw: pd.DataFrame, path: Path, name: str, use: str) -> pd.Series:
    if name not in raw.columns:
        known = ', '.join(map(str, raw.columns))
        raise TableError(f'{path}: no column {name!r} for {use}, expected one of {known}')
    return raw[name]


def _factors(
    raw: pd.DataFrame, path: Path, response: str, factors: Sequence[str] | None
) -> tuple[str, ...]:
    known = ', '.join(map(str, raw.columns))
    _column(raw, path, response, 'the response')
    if factors is None:
        names = tuple(
            name
            for name in map(str, raw.columns)
            if len(name) == 1 and 'A' <= name <= 'Z' and name != response
        )
        if not names:
            raise TableError(f'{path}: no column named by one capital letter, found {known}')
        return tuple(sorted(names))
    for name in factors:
        if len(name) != 1 or not name.isalpha():
            raise TableError(f'factor {name!r}: expected the name of a one-letter column')
        if name not in raw.columns:
            raise TableError(f'{path}: no factor column {name!r}, found {known}')
    return tuple(sorted(factors))


def _table(
    path: Path,
    response: str,
    factors: tuple[str, ...],
    design: str,
    blocks: str,
    raw: pd.DataFrame,
) -> RunTable:
    try:
        rows, caveats = build_rows(raw, factors)
    except TableError as error:
        raise TableError(f'{path}: {error}') from error
    title = path.stem if design in ('', path.stem) else f'{path.stem} {design}'
    return RunTable(
        title, str(path), response, factors, rows, caveats, design, block_column=blocks
    )


def read_responses(
    path: Path, response: str, factors: Sequence[str] | None = None
) -> dict[str, list[float]]:
    """Return the responses of a CSV file of runs by the label of their combination.

    Raises:
        TableError: A column is missing, a level is not ±1 or a response not a number.
    """
    raw = _read(path)
    names = _factors(raw, path, response, factors)
    levels = raw[list(names)]
    if not levels.isin([-1, 1]).to_numpy().all():
        raise TableError(f'{path}: expected levels of -1 or 1')
    values = pd.to_numeric(raw[response], errors='coerce')
    if not np.isfinite(values).all():
        raise TableError(f'{path}: expected a number in every row of {response!r}')
    groups = values.groupby(pd.Series(labels(levels), index=raw.index))
    return {str(label): group.tolist() for label, group in groups}
