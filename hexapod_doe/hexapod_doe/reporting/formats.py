# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""How the report writes numbers, intervals and sets in its sentences and tables."""

import math
from collections.abc import Sequence

_WORDS = ('no', 'one', 'two', 'three', 'four', 'five', 'six', 'seven', 'eight', 'nine', 'ten')
_MINUS = '−'
MISSING = '–'
"""Stands for a number that does not exist."""


def number(value: float | None, digits: int = 3) -> str:
    """Return a number with at least `digits` significant digits and no needless ones."""
    if value is None or not math.isfinite(value):
        return MISSING
    if value == 0:
        return '0'
    decimals = max(0, digits - 1 - math.floor(math.log10(abs(value))))
    text = f'{abs(value):.{decimals}f}' if decimals <= 6 else f'{abs(value):.{digits - 1}e}'
    return (_MINUS if value < 0 else '') + text


def signed(value: float | None, digits: int = 3) -> str:
    """Return a number with its sign."""
    text = number(value, digits)
    return text if text == MISSING or text.startswith(_MINUS) or value == 0 else f'+{text}'


def aligned(values: Sequence[float | None], digits: int = 3, sign: bool = False) -> list[str]:
    """Return a column of numbers with the decimals that its largest one needs."""
    finite = [abs(v) for v in values if v is not None and math.isfinite(v) and v != 0]
    decimals = max(0, digits - 1 - math.floor(math.log10(max(finite)))) if finite else 0
    return [
        MISSING
        if value is None or not math.isfinite(value)
        else ('+' if sign and round(value, decimals) > 0 else '') + number_fixed(value, decimals)
        for value in values
    ]


def plain(value: float) -> str:
    """Return a number that was given as it was given."""
    return f'{value:g}'.replace('-', _MINUS)


def chance(share: float | None) -> str:
    """Return a probability that was estimated by draws: never certain, never impossible."""
    if share is None or not math.isfinite(share):
        return MISSING
    if share > 0.995:
        return '>99 %'
    return '<1 %' if share < 0.005 else percent(share)


def interval(bounds: Sequence[float | None], digits: int = 3) -> str:
    """Return an interval as `low to high`."""
    if all(bound is None for bound in bounds):
        return MISSING
    return ' to '.join(number(bound, digits) for bound in bounds)


def probability(p: float | None) -> str:
    """Return a p-value as it is usually printed."""
    if p is None or not math.isfinite(p):
        return MISSING
    return '<0.001' if p < 0.001 else f'{p:.3f}'


def percent(share: float | None, decimals: int = 0) -> str:
    """Return a share as per cent."""
    if share is None or not math.isfinite(share):
        return MISSING
    return f'{number_fixed(100 * share, decimals)} %'


def number_fixed(value: float, decimals: int) -> str:
    """Return a number with fixed decimals and a real minus sign."""
    text = f'{abs(value):.{decimals}f}'
    return (_MINUS if value < 0 and float(text) else '') + text


def count(value: int, noun: str, plural: str = '') -> str:
    """Return a count in words up to ten, with its noun: `one run`, `12 runs`."""
    word = _WORDS[value] if 0 <= value < len(_WORDS) else f'{value}'
    return f'{word} {noun if value == 1 else plural or noun + "s"}'


def listing(items: Sequence[str], limit: int = 8) -> str:
    """Return items joined for a sentence, the rest counted beyond a limit."""
    shown = list(items[:limit])
    if len(items) > limit:
        shown.append(f'{len(items) - limit} more')
    if len(shown) < 2:
        return ''.join(shown)
    return f'{", ".join(shown[:-1])} and {shown[-1]}'


def capitalised(text: str) -> str:
    """Return a sentence with its first letter in upper case and the others as they are."""
    return text[:1].upper() + text[1:]
