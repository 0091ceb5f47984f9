# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What each substitution stands for, given the scope it is evaluated in."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from ros2_mini.errors import CommandError
from ros2_mini.launch.substitutions import Substitution, SubstitutionError, Template
from ros2_mini.packages import package_prefix, package_share


@dataclass(frozen=True)
class Context:
    """What substitutions read: launch configurations, environment and the file they stand in."""

    configurations: dict[str, str]
    environment: dict[str, str]
    file: Path


def evaluate(template: Template, context: Context) -> str:
    """Return the text that a template stands for.

    Raises:
        SubstitutionError: If a substitution is unknown, or has no value here.
    """
    return ''.join(
        piece if isinstance(piece, str) else _evaluate_one(piece, context) for piece in template
    )


def as_bool(text: str) -> bool:
    """Return the truth value of a condition: true, 1, false or 0, in any case.

    Raises:
        SubstitutionError: If the text is none of these.
    """
    value = {'true': True, '1': True, 'false': False, '0': False}.get(text.strip().lower())
    if value is None:
        raise SubstitutionError(f"'{text}' is no condition, expected true, 1, false or 0")
    return value


def _evaluate_one(substitution: Substitution, context: Context) -> str:
    if substitution.name not in FUNCTIONS:
        raise SubstitutionError(
            f'$({substitution.name}) is not supported; supported: {", ".join(sorted(FUNCTIONS))}'
        )
    least, most, function = FUNCTIONS[substitution.name]
    if not least <= len(substitution.arguments) <= most:
        expected = str(least) if least == most else f'{least} or {most}'
        raise SubstitutionError(
            f'$({substitution.name}) has {len(substitution.arguments)} argument(s), '
            f'expected {expected}'
        )
    return function(context, *(evaluate(part, context) for part in substitution.arguments))


def _var(context: Context, name: str, default: str | None = None) -> str:
    value = context.configurations.get(name, default)
    if value is None:
        raise SubstitutionError(f"launch configuration '{name}' does not exist")
    return value


def _env(context: Context, name: str, default: str | None = None) -> str:
    value = context.environment.get(name, default)
    if value is None:
        raise SubstitutionError(f"environment variable '{name}' does not exist")
    return value


def _find(find: Callable[[str], Path]) -> Callable[[Context, str], str]:
    def function(context: Context, package: str) -> str:
        try:
            return str(find(package))
        except CommandError as error:
            raise SubstitutionError(str(error)) from error

    return function


def _equal(left: str, right: str) -> bool:
    """Compare as the launch library does: as conditions, then as numbers, then as text."""
    try:
        return as_bool(left) == as_bool(right)
    except SubstitutionError:
        pass  # Not both conditions: compare as numbers.
    try:
        return math.isclose(float(left), float(right))
    except ValueError:
        return left == right


def _word(value: bool) -> str:
    return str(value).lower()


# Name -> least and greatest number of arguments, function of the context and the arguments.
FUNCTIONS: dict[str, tuple[int, int, Callable[..., str]]] = {
    'and': (2, 2, lambda _, left, right: _word(as_bool(left) and as_bool(right))),
    'dirname': (0, 0, lambda context: str(context.file.parent)),
    'env': (1, 2, _env),
    'equals': (2, 2, lambda _, left, right: _word(_equal(left, right))),
    'filename': (0, 0, lambda context: str(context.file)),
    'find-pkg-prefix': (1, 1, _find(package_prefix)),
    'find-pkg-share': (1, 1, _find(package_share)),
    'if': (2, 3, lambda _, condition, yes, no='': yes if as_bool(condition) else no),
    'not': (1, 1, lambda _, value: _word(not as_bool(value))),
    'not-equals': (2, 2, lambda _, left, right: _word(not _equal(left, right))),
    'or': (2, 2, lambda _, left, right: _word(as_bool(left) or as_bool(right))),
    'var': (1, 2, _var),
}
