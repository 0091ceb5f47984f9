# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A table's file as headings and cells: where its headings are and what parts its columns.

The line of the headings is the first one that has the wanted ones, under the separator that finds
them; nothing is guessed from the look of the numbers.
"""

import csv
import io
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from hexapod_doe.errors import TableError
from hexapod_doe.sheets.headings import clean, find
from hexapod_doe.sheets.text_file import read_text

SEPARATORS = {',': 'commas', ';': 'semicolons', '\t': 'tabs', '|': 'bars', ' ': 'blanks'}
_COMMENT = '#'
_HINT = re.compile(r'"?sep=(.)"?[,;\t]*', re.IGNORECASE)
_SEARCHED = 40
"""Lines in which the headings are looked for."""
_NAMED = 8
"""Line numbers that a note names before it counts the rest."""

Record = tuple[int, list[str]]
"""The number of a line, from 1, and its fields."""


@dataclass(frozen=True)
class Sheet:
    """The cells of a table as text."""

    path: Path
    headings: tuple[str, ...]
    """Without blanks around them; a name may occur twice."""
    cells: pd.DataFrame
    """One row per filled line, indexed by its number in the file; columns 0, 1, … by position."""
    separator: str
    notes: tuple[str, ...]
    """What was assumed, in sentences."""

    def column(self, position: int) -> pd.Series:
        """Return the cells of a column without blanks around them."""
        return self.cells[position].str.strip()


@dataclass(frozen=True)
class _Head:
    """A line that may hold the headings."""

    separator: str
    line: int
    headings: list[str]
    commented: bool
    """Whether it begins with `#`, as numpy writes headings."""

    @property
    def place(self) -> tuple[bool, int, bool, int]:
        """What makes it the better one of two that have the wanted headings: the lower one."""
        return (self.commented, self.line, self.separator == ' ', -len(self.headings))


def read_sheet(path: Path, wanted: Sequence[str]) -> Sheet:
    """Read a table of any separator and encoding.

    Args:
        path: The file.
        wanted: Headings that its columns should have; where they are not found, the first line
            is taken as the one of the headings, for the caller to say what is missing.

    Raises:
        TableError: It is no table, or a line has more or fewer fields than the headings.
        FileNotFoundError: There is no such file.
    """
    text, notes = read_text(path)
    lines = text.split('\n')
    only, lines = _hint(lines)
    comments = [i for i, line in enumerate(lines) if line.lstrip().startswith(_COMMENT)]
    body = '\n'.join('' if i in set(comments) else line for i, line in enumerate(lines))
    parsed = {mark: _parse(body, mark) for mark in only or SEPARATORS}
    heads = _heads(parsed, [(i + 1, lines[i]) for i in comments])
    head = _wanted(heads, parsed, wanted)
    faults = [fault for mark, (_, fault) in parsed.items() if fault and mark != ' ']
    if head is not None:
        faults = [fault] if (fault := parsed[head.separator][1]) else []
    if faults:
        raise TableError(f'{path}: {faults[0]}')
    head = head or _first(heads)
    if head is None:
        raise TableError(f'{path}: no line but blank ones and comments, expected a header')
    records = parsed[head.separator][0]
    rows = [record for record in records if record[0] > head.line]
    frame = pd.DataFrame(
        [_fields(record, head.headings, path) for record in rows],
        index=[line for line, _ in rows],
        columns=range(len(head.headings)),
        dtype=str,
    )
    above = [line for line, _ in records if line < head.line]
    passed = [i + 1 for i in comments if i + 1 != head.line]
    notes = (*notes, *_notes(path, head, above, passed))
    return Sheet(path, tuple(head.headings), frame, head.separator, notes)


def _hint(lines: list[str]) -> tuple[list[str], list[str]]:
    """Return the separator that Excel's first line `sep=;` fixes, if any, and the lines."""
    found = _HINT.fullmatch(lines[0])
    return ([found[1]], ['', *lines[1:]]) if found else ([], lines)


def _parse(text: str, separator: str) -> tuple[list[Record], str]:
    """Return the lines that are not blank, up to a fault of the quotes, and the fault."""
    reader = csv.reader(
        io.StringIO(text, newline=''), delimiter=separator, skipinitialspace=True, strict=True
    )
    records: list[Record] = []
    line = 1
    try:
        for fields in reader:
            if any(field.strip() for field in fields):
                records.append((line, fields))
            line = reader.line_num + 1
    except csv.Error as error:
        return records, f'line {line}: {error}; is a quote left open?'
    return records, ''


def _heads(
    parsed: dict[str, tuple[list[Record], str]], comments: list[tuple[int, str]]
) -> list[_Head]:
    """Return the lines that may hold the headings, under each separator."""
    return [
        *(
            _Head(mark, line, _headings(fields), commented=False)
            for mark, (records, _) in parsed.items()
            for line, fields in records[:_SEARCHED]
        ),
        *(
            _Head(mark, line, _headings(fields), commented=True)
            for mark in parsed
            for line, text in comments[:_SEARCHED]
            for _, fields in _parse(text.strip().lstrip(_COMMENT), mark)[0]
        ),
    ]


def _wanted(
    heads: list[_Head], parsed: dict[str, tuple[list[Record], str]], wanted: Sequence[str]
) -> _Head | None:
    """Return the line that has the wanted headings."""
    having = [head for head in heads if all(find(head.headings, name) for name in wanted)]
    fitting = [head for head in having if _fits(head, parsed[head.separator][0])]
    return min(fitting or having, key=lambda head: head.place, default=None)


def _first(heads: list[_Head]) -> _Head | None:
    """Return the first line, at its widest."""
    bare = [head for head in heads if not head.commented]
    first = min((head.line for head in bare), default=0)
    return max(
        (head for head in bare if head.line == first),
        key=lambda head: (head.separator != ' ' and len(head.headings) > 1, len(head.headings)),
        default=None,
    )


def _headings(fields: list[str]) -> list[str]:
    """Return clean headings, without the blank ones at the end."""
    headings = [clean(field) for field in fields]
    while headings and not headings[-1]:
        headings.pop()
    return headings


def _fits(head: _Head, records: list[Record]) -> bool:
    """Whether the next line has as many fields: a title has not."""
    after = next((fields for line, fields in records if line > head.line), None)
    return after is None or len(after) >= len(head.headings)


def _fields(record: Record, headings: list[str], path: Path) -> list[str]:
    """Return the fields of a line under the headings; what is beyond them must be blank."""
    line, fields = record
    count = len(headings)
    if len(fields) < count or any(field.strip() for field in fields[count:]):
        raise TableError(
            f'{path} line {line}: {len(fields)} fields, expected {count} as in the line of the '
            f'headings ({", ".join(headings)}); leave a field empty where there is no value'
        )
    return fields[:count]


def _notes(path: Path, head: _Head, above: list[int], passed: list[int]) -> list[str]:
    notes = []
    if head.separator != ',':
        notes.append(f'The columns of {path.name} are parted by {SEPARATORS[head.separator]}.')
    if above:
        notes.append(f'{path.name}: {_lines(above)} left out: above the headings.')
    if passed:
        notes.append(f'{path.name}: {_lines(passed)} left out: {_COMMENT} comes first.')
    return notes


def _lines(numbers: list[int]) -> str:
    shown = ', '.join(map(str, numbers[:_NAMED])) + (' …' if len(numbers) > _NAMED else '')
    return f'line {shown} is' if len(numbers) == 1 else f'{len(numbers)} lines ({shown}) are'
