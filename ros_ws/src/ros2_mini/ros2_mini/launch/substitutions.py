# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Substitutions such as `$(var name)` in the attributes of a launch file.

The grammar is that of the launch library: a name, then arguments set apart by one space each;
an argument is a run of text and substitutions, in quotes where it holds spaces; a backslash takes
the next character literally.
"""

import re
from dataclasses import dataclass
from typing import TypeAlias


class SubstitutionError(ValueError):
    """A substitution that cannot be read or has no value; the message quotes it."""


@dataclass(frozen=True)
class Substitution:
    """A substitution as written, its arguments not yet evaluated."""

    name: str
    arguments: tuple['Template', ...]


Template: TypeAlias = tuple[str | Substitution, ...]

_NAME = re.compile(r'[A-Za-z][A-Za-z0-9_-]*')


def parse(text: str) -> Template:
    """Split a text into literal pieces and substitutions.

    Raises:
        SubstitutionError: If a `$(` is not a complete substitution.
    """
    return _Reader(text).template(stop='')


class _Reader:
    """A recursive descent over one text."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._at = 0

    def _peek(self, length: int = 1) -> str:
        return self._text[self._at : self._at + length]

    def _fail(self, expected: str) -> SubstitutionError:
        return SubstitutionError(f"'{self._text}', column {self._at + 1}: expected {expected}")

    def template(self, stop: str) -> Template:
        """Read pieces up to one of the characters of `stop`, which is left unread."""
        pieces: list[str | Substitution] = []
        literal = ''
        while self._peek() and self._peek() not in stop:
            if self._peek(2) == '$(':
                pieces += [literal] if literal else []
                literal = ''
                pieces.append(self._substitution())
                continue
            if self._peek() == '\\' and len(self._peek(2)) == 2:
                self._at += 1
            literal += self._peek()
            self._at += 1
        return (*pieces, literal) if literal else tuple(pieces)

    def _substitution(self) -> Substitution:
        self._at += len('$(')
        name = _NAME.match(self._text, self._at)
        if name is None:
            raise self._fail('the name of a substitution')
        self._at = name.end()
        arguments = []
        while self._peek() == ' ':
            self._at += 1
            arguments.append(self._argument())
        if self._peek() != ')':
            raise self._fail("')'")
        self._at += 1
        return Substitution(name[0], tuple(arguments))

    def _argument(self) -> Template:
        quote = self._peek()
        if quote in ('"', "'"):
            self._at += 1
            argument = self.template(stop=quote)
            if self._peek() != quote:
                raise self._fail(quote)
            self._at += 1
            return argument
        argument = self.template(stop=' ()"\'')
        if not argument:
            raise self._fail('an argument')
        return argument
