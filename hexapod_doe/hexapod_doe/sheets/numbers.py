# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Numbers of cells: decimal points and commas, groups of thousands, minus signs, missing ones."""

import math
import re
from collections.abc import Iterable

POINT, COMMA = '.', ','
MISSING = frozenset(
    {
        '', '*', '.', '?', '-', '--', '−', '–', '—', 'na', 'n/a', 'n.a.', '#n/a', '<na>', 'nan',
        'null', 'none', 'missing',
    }
)  # fmt: skip
"""Cells of runs without a result, in lower case."""

_MINUS = str.maketrans(dict.fromkeys('−‐‑‒–—﹣－', '-') | {'＋': '+'})
_BLANKS = re.compile(r"(?<=[0-9])[ \u00a0\u2009\u202f'’](?=[0-9]{3}(?![0-9]))")
_SIGNED = re.compile(r'[+-]?(?P<body>[.,]?[0-9][0-9.,]*)(?:[eE][+-]?[0-9]+)?')
_INFINITE = re.compile(r'[+-]?(?:inf|infinity|∞)', re.IGNORECASE)
_GROUPED = {
    mark: re.compile(rf'[0-9]{{1,3}}(?:{re.escape(group)}[0-9]{{3}})+(?:{re.escape(mark)}[0-9]*)?')
    for mark, group in ((POINT, COMMA), (COMMA, POINT))
}
_PLAIN = {
    mark: re.compile(rf'(?:[0-9]+{re.escape(mark)}?[0-9]*|{re.escape(mark)}[0-9]+)')
    for mark in (POINT, COMMA)
}


def plain(cell: str) -> str:
    """Return a cell with ASCII signs, without blanks and what spreadsheets put around a text."""
    text = cell.strip()
    if text.startswith('="') and text.endswith('"'):
        text = text[2:-1].strip()
    return _BLANKS.sub('', text.translate(_MINUS))


def is_missing(cell: str) -> bool:
    """Whether a cell is one of the marks of a missing value."""
    return cell.strip().casefold() in MISSING


def has_other_minus(cells: Iterable[str]) -> bool:
    """Whether a number of some cell has a minus that is not the ASCII one."""
    return any(
        cell.strip()[:1] not in ('', '-') and plain(cell)[0] == '-'
        for cell in cells
        if not is_missing(cell) and plain(cell) and not cell.strip().startswith('=')
    )


def number(cell: str, mark: str = POINT) -> float:
    """Return the number of a cell; it may be infinite.

    Args:
        cell: Its text.
        mark: The decimal mark, `POINT` or `COMMA`; the other one may part thousands.

    Raises:
        ValueError: It holds no number.
    """
    text = plain(cell)
    if _INFINITE.fullmatch(text):
        return -math.inf if text.startswith('-') else math.inf
    found = _SIGNED.fullmatch(text)
    if not found:
        raise ValueError(f'{cell!r} is no number')
    body = found['body']
    if _PLAIN[mark].fullmatch(body):
        return float(text.replace(mark, POINT))
    if _GROUPED[mark].fullmatch(body):
        group = COMMA if mark == POINT else POINT
        return float(text.replace(group, '').replace(mark, POINT))
    raise ValueError(f'{cell!r} is no number with a decimal {_NAMES[mark]}')


_NAMES = {POINT: 'point', COMMA: 'comma'}


def decimal_mark(cells: Iterable[str], separator: str) -> str:
    """Return the decimal mark of a table's numbers, `POINT` or `COMMA`.

    Args:
        cells: The cells of the columns of numbers.
        separator: What parts the table's columns; with a semicolon, `1,234` is 1.234.

    Raises:
        ValueError: The cells disagree, or both readings are possible.
    """
    bodies = {}
    for cell in cells:
        found = None if is_missing(cell) else _SIGNED.fullmatch(plain(cell))
        if found and (POINT in found['body'] or COMMA in found['body']):
            bodies[found['body']] = cell.strip()
    shown = {_evidence(body): cell for body, cell in bodies.items()}
    if POINT in shown and COMMA in shown:
        raise ValueError(
            f'{shown[POINT]!r} has a decimal point and {shown[COMMA]!r} a decimal comma: '
            'write all numbers alike'
        )
    if POINT in shown or COMMA in shown:
        return POINT if POINT in shown else COMMA
    doubtful = [cell for cell in bodies.values() if COMMA in cell]
    if not doubtful:
        return POINT
    if separator == ';' and len(doubtful) == len(bodies):
        return COMMA
    raise ValueError(
        f'{doubtful[0]!r} may have a decimal comma or a comma that parts thousands: '
        'write the numbers with a decimal point and no other mark'
    )


def _evidence(body: str) -> str:
    """Return the decimal mark that digits and marks show, or nothing where both are possible."""
    points, commas = body.count(POINT), body.count(COMMA)
    if points and commas:
        return POINT if body.rfind(POINT) > body.rfind(COMMA) else COMMA
    mark, other = (POINT, COMMA) if points else (COMMA, POINT)
    if points + commas > 1:
        return other
    return '' if _GROUPED[other].fullmatch(body) and not body.startswith('0') else mark
