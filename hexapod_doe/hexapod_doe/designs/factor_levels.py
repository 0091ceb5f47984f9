# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Checks the levels of a factor by what a specification has under its key."""

from collections.abc import Mapping
from dataclasses import is_dataclass, replace
from typing import Any, get_args, get_type_hints

from hexapod_agent.specification.run_spec import RunSpec
from hexapod_agent.specification.spec_text import ConfigError, quoted
from pydantic import TypeAdapter, ValidationError

from hexapod_doe.designs.factor import Factor

_PER_RUN = ('training.episodes', 'training.evaluation')
"""Keys that a campaign sets for all of its runs."""


def check_levels(factor: Factor, base: RunSpec) -> Factor:
    """Return a factor with its levels as the specification has them.

    Raises:
        ConfigError: The key is unknown or has no value of its own, a level is not allowed, or both
            are equal.
    """
    where = f'factor {factor.name!r}'
    found = key_value(base, factor.key, where)
    if factor.key in _PER_RUN:
        raise ConfigError(
            f'{where}: key {factor.key} is the same for all runs of a campaign, expected another'
        )
    levels = []
    for name, level in (('low', factor.low), ('high', factor.high)):
        source = f'{where}: {name} level'
        if isinstance(level, bool) != isinstance(found, bool) and found is not None:
            kind = 'true or false' if isinstance(found, bool) else f'a value such as {found!r}'
            raise ConfigError(f'{source}: {factor.key} is {quoted(level)}, expected {kind}')
        levels.append(_validated(base, factor.key, level, source))
    if levels[0] == levels[1]:
        both = f'low and high level of {factor.key} are both {quoted(levels[0])}'
        raise ConfigError(f'{where}: {both}, expected two values')
    return replace(factor, low=levels[0], high=levels[1])


def key_value(base: RunSpec, key: str, where: str) -> Any:
    """Return what a specification has under a key.

    Raises:
        ConfigError: Nothing, or a section of keys; the text names those that there are.
    """
    found: Any = base.to_mapping()
    path = ''
    for part in key.split('.'):
        if not isinstance(found, Mapping) or part not in found:
            raise ConfigError(f'{where}: unknown key {quoted(key)}, {_allowed(found, path)}')
        found, path = found[part], f'{path}{part}.'
    if isinstance(found, Mapping):
        raise ConfigError(f'{where}: key {key!r} is a section, {_allowed(found, path)}')
    return found


def _validated(base: RunSpec, key: str, level: Any, source: str) -> Any:
    """Return a level as a specification has it, whether or not it goes with the other values."""
    kind: Any
    found: Any = base
    for part in key.split('.'):
        if is_dataclass(found):
            hints = get_type_hints(type(found), include_extras=True)
            kind, found = hints[part], getattr(found, part)
        else:  # a mapping, of channels
            kind, found = get_args(kind)[1], found[part]
    try:
        return TypeAdapter(kind).validate_python(level)
    except ValidationError as error:
        expected = error.errors()[0]['msg']
        raise ConfigError(f'{source}: {key} is {quoted(level)}, expected: {expected}') from error


def _allowed(found: Any, path: str) -> str:
    if not isinstance(found, Mapping):
        return f'expected {path.rstrip(".")}'
    return f'expected one of {", ".join(f"{path}{name}" for name in found)}'
