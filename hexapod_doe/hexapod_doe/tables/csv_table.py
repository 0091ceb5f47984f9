# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Reads tables of runs from files, whatever program wrote them, and notes what was assumed."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from hexapod_doe.errors import TableError
from hexapod_doe.fitting.model import labels
from hexapod_doe.sheets.numbers import decimal_mark
from hexapod_doe.sheets.sheet import Sheet, read_sheet
from hexapod_doe.tables.columns import (
    Columns,
    coded_levels,
    find_columns,
    number_note,
    responses,
    run_numbers,
)
from hexapod_doe.tables.table import BLOCK, RESPONSE, RunTable, build_rows


def read_csv(
    path: Path,
    response: str,
    factors: Sequence[str] | None = None,
    blocks: str = '',
) -> list[RunTable]:
    """Read a file with headings; a column `design` splits it into several tables.

    Columns may be parted by commas, semicolons, tabs, bars or blanks, numbers may have a decimal
    comma, and the text any usual encoding. What was assumed stands in the tables' caveats.

    Args:
        path: The file.
        response: Name of the response column.
        factors: One-character factor columns; by default all columns named by one capital letter.
        blocks: Column that tells the blocks apart; empty for none.

    Raises:
        TableError: The file is no table or has no such column, a heading or number may be read
            in two ways, or the rows cannot be analysed.
        FileNotFoundError: There is no such file.
    """
    sheet = read_sheet(path, [response])
    columns = find_columns(sheet, response, factors, blocks)
    tidy, notes = _tidy(sheet, columns)
    names = columns.names
    if columns.design is None:
        groups = [('', tidy)]
    else:
        designs = sheet.column(columns.design)
        if designs.eq('').any():
            row = int(np.argmax(designs.eq('')))
            raise TableError(
                f"{path}: row {row + 1} (line {designs.index[row]}): column 'design' is blank, "
                "expected the name of the row's design"
            )
        groups = [(str(name), part) for name, part in tidy.groupby(designs, sort=False)]
    return [
        _table(path, response, names, name, blocks, part.reset_index(drop=True), notes)
        for name, part in groups
    ]


def _tidy(sheet: Sheet, columns: Columns) -> tuple[pd.DataFrame, tuple[str, ...]]:
    """Return the columns of an analysis as numbers, and what was assumed."""
    mark = _mark(sheet, columns)
    levels, signs = coded_levels(sheet, columns, mark)
    values = responses(sheet, columns.response, mark)
    numbers, left_out = run_numbers(sheet, columns)
    tidy = levels.join(numbers).assign(**{RESPONSE: values})
    if columns.blocks is not None:
        block = sheet.column(columns.blocks)
        tidy[BLOCK] = block.mask(block == '')
    notes = (*sheet.notes, *number_note(sheet, columns, mark), *signs, *left_out, *columns.notes)
    return tidy, notes


def _mark(sheet: Sheet, columns: Columns) -> str:
    """Return the decimal mark of the levels and responses."""
    cells = [
        cell
        for position in (columns.response, *columns.factors.values())
        for cell in sheet.column(position)
    ]
    try:
        return decimal_mark(cells, sheet.separator)
    except ValueError as error:
        raise TableError(f'{sheet.path}: {error}') from error


def _table(
    path: Path,
    response: str,
    factors: tuple[str, ...],
    design: str,
    blocks: str,
    raw: pd.DataFrame,
    notes: tuple[str, ...],
) -> RunTable:
    try:
        rows, caveats = build_rows(raw, factors)
    except TableError as error:
        raise TableError(f'{path}: {error}') from error
    title = path.stem if design in ('', path.stem) else f'{path.stem} {design}'
    return RunTable(
        title, str(path), response, factors, rows, (*notes, *caveats), design, block_column=blocks
    )


def read_responses(
    path: Path, response: str, factors: Sequence[str] | None = None
) -> dict[str, list[float]]:
    """Return the responses of a file of runs by the label of their combination.

    Raises:
        TableError: The file is no table, a column is missing, a level is not ±1, a response is
            not a number, or something may be read in two ways.
    """
    sheet = read_sheet(path, [response])
    columns = find_columns(sheet, response, factors)
    mark = _mark(sheet, columns)
    levels, _ = coded_levels(sheet, columns, mark)
    if not levels.isin([-1, 1]).to_numpy().all():
        raise TableError(f'{path}: expected levels of -1 or 1')
    values = responses(sheet, columns.response, mark)
    if not np.isfinite(values).all():
        raise TableError(f'{path}: expected a number in every row of {response!r}')
    groups = values.groupby(pd.Series(labels(levels), index=values.index))
    return {str(label): group.tolist() for label, group in groups}
