# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Substitutions such as `$(var name)` in the attributes of a launch file.

The grammar is that of the launch library: a name, then arguments set apart by one space each;
an argument is a run of text and substitutions, in quotes where it holds spaces; a backslash takes
the next character literally.
"""

import contextlib
import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

from ros2_mini.errors import CommandError
from ros2_mini.packages import package_share


class SubstitutionError(ValueError):
    """A substitution that cannot be read or has no value; the message quotes it."""


@dataclass(frozen=True)
class Substitution:
    """A substitution as written, its arguments not yet evaluated."""

    name: str
    arguments: tuple['Template', ...]


Template: TypeAlias = tuple[str | Substitution, ...]
Configurations: TypeAlias = Mapping[str, str]

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


def evaluate(template: Template, configurations: Configurations, file: Path) -> str:
    """Return the text that a template in a launch file stands for.

    Args:
        template: What to evaluate.
        configurations: Launch configurations by name.
        file: The launch file that it stands in.

    Raises:
        SubstitutionError: If a substitution is unknown, or has no value here.
    """

    def value(piece: str | Substitution) -> str:
        if isinstance(piece, str):
            return piece
        count, function = _function(piece)
        if count != len(piece.arguments):
            raise SubstitutionError(
                f'$({piece.name}) has {len(piece.arguments)} argument(s), expected {count}'
            )
        arguments = [evaluate(part, configurations, file) for part in piece.arguments]
        return function(configurations, file, *arguments)

    return ''.join(map(value, template))


def as_bool(text: str) -> bool:
    """Return the truth value of a condition: true, 1, false or 0, in any case.

    Raises:
        SubstitutionError: If the text is none of these.
    """
    value = {'true': True, '1': True, 'false': False, '0': False}.get(text.strip().lower())
    if value is None:
        raise SubstitutionError(f"'{text}' is no condition, expected true, 1, false or 0")
    return value


def _function(substitution: Substitution) -> tuple[int, Callable[..., str]]:
    if substitution.name not in _FUNCTIONS:
        raise SubstitutionError(
            f'$({substitution.name}) is not supported; supported: {", ".join(sorted(_FUNCTIONS))}'
        )
    return _FUNCTIONS[substitution.name]


def _var(configurations: Configurations, file: Path, name: str) -> str:
    if name not in configurations:
        raise SubstitutionError(f"launch configuration '{name}' does not exist")
    return configurations[name]


def _find_pkg_share(configurations: Configurations, file: Path, package: str) -> str:
    try:
        return str(package_share(package))
    except CommandError as error:
        raise SubstitutionError(str(error)) from error


def _equals(configurations: Configurations, file: Path, left: str, right: str) -> str:
    """Compare as the launch library does: as conditions, then as numbers, then as text."""
    same = left == right
    with contextlib.suppress(ValueError):
        same = math.isclose(float(left), float(right))
    with contextlib.suppress(ValueError):
        same = as_bool(left) == as_bool(right)
    return str(same).lower()


# Name -> number of arguments, function of the configurations, the file and the arguments.
_FUNCTIONS: dict[str, tuple[int, Callable[..., str]]] = {
    'dirname': (0, lambda configurations, file: str(file.parent)),
    'equals': (2, _equals),
    'find-pkg-share': (1, _find_pkg_share),
    'var': (1, _var),
}
