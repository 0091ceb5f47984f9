# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Which column of a table is what, and what its cells say; nothing is left out without a word."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from hexapod_doe.errors import TableError
from hexapod_doe.sheets.headings import clean, described, find, latin
from hexapod_doe.sheets.numbers import COMMA, POINT, has_other_minus, is_missing, number, plain
from hexapod_doe.sheets.sheet import Sheet

DESIGN_COLUMN = 'design'
RUN_COLUMNS = ('run_id', 'case', 'StdOrder', 'replicate', 'RunOrder')
_NUMBERS = ('StdOrder', 'replicate', 'RunOrder')
_SIGNS = {'+': 1.0, '-': -1.0}
_LARGEST = 1e100
"""Responses of this size have squares that a float cannot sum."""


@dataclass(frozen=True)
class Columns:
    """Positions of the columns of an analysis."""

    response: int
    factors: Mapping[str, int]
    """Letter to position, in the order of the alphabet."""
    blocks: int | None
    design: int | None
    runs: Mapping[str, int]
    """Those of `RUN_COLUMNS` that there are."""
    notes: tuple[str, ...]
    """What was assumed of headings, and which columns are not used."""

    @property
    def names(self) -> tuple[str, ...]:
        """The factors' letters."""
        return tuple(self.factors)


def find_columns(
    sheet: Sheet, response: str, factors: Sequence[str] | None, blocks: str = ''
) -> Columns:
    """Return where a table has what an analysis needs.

    Raises:
        TableError: There is no such column, or a heading fits two.
    """
    place = _column(sheet, response, 'the response')
    block = _column(sheet, blocks, 'blocks') if blocks else None
    found = _lettered(sheet, place) if factors is None else _named(sheet, factors)
    if not found:
        raise TableError(
            f'{sheet.path}: no column named by one capital letter, found {_known(sheet)}'
        )
    taken = {place, *found.values()}
    special = {
        name: positions[0]
        for name in (*RUN_COLUMNS, DESIGN_COLUMN)
        if len(positions := find(sheet.headings, name)) == 1 and positions[0] not in taken
    }
    design = special.pop(DESIGN_COLUMN, None)
    if design is not None and sheet.column(design).eq('').all():
        design = None
    used = taken | set(special.values()) | ({block, design} - {None})
    notes = (
        *_renamed(sheet, {response: place, **({blocks: block} if block is not None else {})}),
        *_renamed(sheet, found),
        *_unused(sheet, used),
    )
    ordered = {name: found[name] for name in sorted(found)}
    return Columns(place, ordered, block, design, special, notes)


def _known(sheet: Sheet) -> str:
    return ', '.join(heading or '(blank)' for heading in sheet.headings)


def _column(sheet: Sheet, name: str, use: str) -> int:
    """Return the one column of a name."""
    positions = find(sheet.headings, name)
    if not positions:
        raise TableError(
            f'{sheet.path}: no column {name!r} for {use}, expected one of {_known(sheet)}'
        )
    return _only(sheet, name, positions)


def _only(sheet: Sheet, name: str, positions: Sequence[int]) -> int:
    if len(positions) > 1:
        columns = ' and '.join(f'{i + 1} ({described(sheet.headings[i])})' for i in positions)
        raise TableError(
            f'{sheet.path}: heading {name!r} fits {len(positions)} columns, {columns}: give each '
            'column a name of its own, and each run a row of its own'
        )
    return positions[0]


def _named(sheet: Sheet, factors: Sequence[str]) -> dict[str, int]:
    """Return the columns of the factors that the user named."""
    twice = [name for name, count in Counter(factors).items() if count > 1]
    if twice:
        raise TableError(f'factor {twice[0]!r} is named twice, expected each factor once')
    for name in factors:
        if len(name) != 1 or not name.isalpha():
            raise TableError(f'factor {name!r}: expected the name of a one-letter column')
        if not find(sheet.headings, name):
            raise TableError(f'{sheet.path}: no factor column {name!r}, found {_known(sheet)}')
    return {name: _only(sheet, name, find(sheet.headings, name)) for name in factors}


def _lettered(sheet: Sheet, response: int) -> dict[str, int]:
    """Return the columns named by one capital letter, or by what must be meant as one.

    A lower-case or look-alike letter is one where the column holds levels only.
    """
    found: dict[str, list[int]] = {}
    for position, heading in enumerate(sheet.headings):
        letter = latin(heading).upper()
        if position == response or len(letter) != 1 or not 'A' <= letter <= 'Z':
            continue
        if heading == letter or _holds_levels(sheet, position):
            found.setdefault(letter, []).append(position)
    return {letter: _only(sheet, letter, positions) for letter, positions in found.items()}


def _holds_levels(sheet: Sheet, position: int) -> bool:
    """Whether a column has both levels, and nothing else but the zeros of centre points."""
    levels = set()
    for cell in sheet.column(position):
        try:
            levels.add(_level(cell, POINT))
        except ValueError:
            return False
    return {-1.0, 1.0} <= levels <= {-1.0, 0.0, 1.0}


def _renamed(sheet: Sheet, columns: Mapping[str, int]) -> list[str]:
    """Say which headings were taken for another name."""
    return [
        f'Column {described(sheet.headings[position])} of {sheet.path.name} is read as '
        f'{clean(name)!r}.'
        for name, position in columns.items()
        if sheet.headings[position] != clean(name)
    ]


def _unused(sheet: Sheet, used: set[int | None]) -> list[str]:
    """Say which columns are not used, and which of them look like factors."""
    rest = [i for i in range(len(sheet.headings)) if i not in used]
    filled = [i for i in rest if sheet.headings[i] or sheet.column(i).ne('').any()]
    if not filled:
        return []
    names = ', '.join(sheet.headings[i] or f'(column {i + 1}, no heading)' for i in filled)
    text = f'Columns of {sheet.path.name} that are not used: {names}.'
    levels = [sheet.headings[i] for i in filled if _holds_levels(sheet, i)]
    if levels:
        text += (
            f' Of these {", ".join(map(described, levels))} hold levels of -1 and 1: a factor '
            'must be named by one capital letter.'
        )
    return [text]


def _level(cell: str, mark: str) -> float:
    text = plain(cell)
    return _SIGNS[text] if text in _SIGNS else number(cell, mark)


def coded_levels(
    sheet: Sheet, columns: Columns, mark: str
) -> tuple[pd.DataFrame, tuple[str, ...]]:
    """Return the factors' levels, one column per letter, and what was assumed of signs.

    Raises:
        TableError: A level is not a number.
    """
    levels = {
        name: [
            _coded(sheet, name, row, line, cell, mark)
            for row, (line, cell) in enumerate(sheet.column(position).items())
        ]
        for name, position in columns.factors.items()
    }
    frame = pd.DataFrame(levels, index=sheet.cells.index, dtype=int)
    return frame, _sign_notes(sheet, columns)


def _coded(sheet: Sheet, name: str, row: int, line: object, cell: str, mark: str) -> int:
    try:
        value = _level(cell, mark)
    except ValueError:
        value = np.nan
    if value not in (-1.0, 0.0, 1.0):
        raise TableError(
            f'{sheet.path}: row {row + 1}, column {name!r} (line {line}): level {cell}, '
            'expected -1 or 1 (0 only in a centre point, where every numeric factor is 0); '
            '--factors A,B,… names the columns that are factors'
        )
    return int(value)


def _sign_notes(sheet: Sheet, columns: Columns) -> tuple[str, ...]:
    cells = [cell for position in columns.factors.values() for cell in sheet.column(position)]
    notes = []
    if any(plain(cell) in _SIGNS for cell in cells):
        notes.append(f'Levels + and - of {sheet.path.name} are read as 1 and -1.')
    if has_other_minus([*cells, *sheet.column(columns.response)]):
        notes.append(f'The sign − (U+2212 or a dash) of {sheet.path.name} is read as a minus.')
    return tuple(notes)


def responses(sheet: Sheet, position: int, mark: str) -> pd.Series:
    """Return the responses; NaN where a run has none.

    Raises:
        TableError: A cell is no number, or one that is not finite or too large to be squared.
    """
    values = [
        np.nan if is_missing(cell) else _response(sheet, row, line, cell, mark)
        for row, (line, cell) in enumerate(sheet.column(position).items())
    ]
    return pd.Series(values, index=sheet.cells.index, dtype=float)


def _response(sheet: Sheet, row: int, line: object, cell: str, mark: str) -> float:
    where, cure = f'{sheet.path}: row {row + 1}', 'leave it empty for a run without a result'
    try:
        value = number(cell, mark)
    except ValueError:
        raise TableError(
            f'{where}: response {cell!r}, expected a number (line {line}); {cure}'
        ) from None
    if not abs(value) < _LARGEST:
        raise TableError(
            f'{where}: response {cell}, expected a number within ±{_LARGEST:g} (line {line}); '
            f'{cure}'
        )
    return value


def number_note(sheet: Sheet, columns: Columns, mark: str) -> list[str]:
    """Say how a number with a mark that is not the usual one was read."""
    group = POINT if mark == COMMA else COMMA
    cells = sheet.column(columns.response)
    shown = next((cell for cell in cells if mark == COMMA and COMMA in cell), '')
    grouped = next((cell for cell in cells if group in cell and not is_missing(cell)), '')
    notes = [
        f'{cell!r} of {sheet.path.name} is read as {number(cell, mark):.15g}.'
        for cell in dict.fromkeys((shown, grouped))
        if cell
    ]
    return [' '.join(notes)] if notes else []


def run_numbers(sheet: Sheet, columns: Columns) -> tuple[pd.DataFrame, tuple[str, ...]]:
    """Return what names the runs, and which of these columns are left out."""
    kept, left_out = {}, []
    for name, position in columns.runs.items():
        cells = sheet.column(position)
        values = pd.to_numeric(cells, errors='coerce')
        whole = values.notna().all() and (values % 1 == 0).all()
        if cells.map(is_missing).any() or (name in _NUMBERS and not whole):
            left_out.append(name)
        elif whole and name != 'run_id':
            kept[name] = values.astype(int)
        else:
            kept[name] = cells
    text = (
        f'{", ".join(left_out)} of {sheet.path.name} lack a number in some row and are not used.'
    )
    frame = pd.DataFrame(kept, index=sheet.cells.index)
    return frame, (text,) if left_out else ()
