# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Headings of columns: what is the same name in spite of blanks, case or look-alike letters."""

import unicodedata
from collections.abc import Sequence

from hexapod_doe.sheets.text_file import INVISIBLE

# Cyrillic and Greek letters that print like Latin ones.
_LOOKALIKES = str.maketrans(
    'АВЕЅІЈКМНОРСТУХаеоѕіјрсухΑΒΕΖΗΙΚΜΝΟΡΤΥΧο',
    'ABESIJKMHOPCTYXaeosijpcyxABEZHIKMNOPTYXo',
)


def clean(heading: str) -> str:
    """Return a heading without blanks around it, with single ones inside."""
    return ' '.join(heading.translate(INVISIBLE).split())


def latin(heading: str) -> str:
    """Return a heading with look-alike, full-width and stylised letters as Latin ones."""
    return unicodedata.normalize('NFKC', clean(heading)).translate(_LOOKALIKES)


def fold(heading: str) -> str:
    """Return what is alike in headings that differ by case, blanks, `_` or look-alikes only."""
    return latin(heading).casefold().replace(' ', '').replace('_', '')


def find(headings: Sequence[str], name: str) -> list[int]:
    """Return the columns of a name: those that are named so, or else those that are alike."""
    name = clean(name)
    exact = [i for i, heading in enumerate(headings) if heading == name]
    return exact or [i for i, heading in enumerate(headings) if fold(heading) == fold(name)]


def described(heading: str) -> str:
    """Return a heading for a message; letters that are not ASCII by their names, too."""
    strange = [
        f'{unicodedata.name(letter, "unnamed").capitalize()}, U+{ord(letter):04X}'
        for letter in heading
        if not letter.isascii()
    ]
    return repr(heading) + (f' ({"; ".join(strange)})' if len(heading) == 1 and strange else '')
