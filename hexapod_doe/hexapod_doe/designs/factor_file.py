# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Reads the factors of an experiment from a YAML file, and checks levels by a specification."""

from collections.abc import Mapping, Sequence
from dataclasses import is_dataclass, replace
from pathlib import Path
from typing import Any, get_args, get_type_hints

from hexapod_agent.specification.run_spec import RunSpec
from hexapod_agent.specification.spec_text import ConfigError, parsed, quoted
from pydantic import TypeAdapter, ValidationError

from hexapod_doe.designs.design import MAX_FACTORS, MIN_FACTORS
from hexapod_doe.designs.factor import OBSERVATIONS, Factor, Treatments
from hexapod_doe.designs.terms import LETTERS

_PER_RUN = ('training.episodes', 'training.evaluation')
"""Keys that a campaign sets for all of its runs."""
_CHOSEN_WHERE_IT_RUNS = {'training.precision': 'auto'}
"""Values that become another one, by key."""


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
        if _CHOSEN_WHERE_IT_RUNS.get(factor.key) == levels[-1]:
            raise ConfigError(
                f'{source}: {factor.key} is {level!r}, which becomes what the processor has, '
                'expected a value that stays'
            )
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


_NEEDED = ('name', 'key', 'low', 'high')
_OPTIONAL = ('device', 'letter')
_LONGEST = 60
"""Characters of a name, so that it fits a column."""


def read_factors(path: Path, base: RunSpec) -> Treatments:
    """Read a list of factors, each with name, key, low, high and perhaps device and letter.

    A sensor has its own letter if the file gives none, other factors the first free ones.

    Args:
        path: The file.
        base: The specification that the levels change.

    Raises:
        ConfigError: The file is no such list, or a factor cannot be had; the text names the file,
            the factor, the key and what is allowed.
        OSError: It cannot be read.
    """
    try:
        entries = parsed(path.read_text(encoding='utf-8'), str(path))
    except UnicodeDecodeError as error:
        raise ConfigError(f'{path}: not YAML: not UTF-8 text') from error
    try:
        return Treatments(factors_of(entries, base), base)
    except ConfigError as error:
        raise ConfigError(f'{path}: {error}') from error


def factors_of(entries: Any, base: RunSpec) -> tuple[Factor, ...]:
    """Return the factors of a file's entries.

    Raises:
        ConfigError: As for `read_factors`.
    """
    if not isinstance(entries, list) or not MIN_FACTORS <= len(entries) <= MAX_FACTORS:
        found = f'{len(entries)} factors' if isinstance(entries, list) else 'no list'
        raise ConfigError(
            f'{found}, expected a list of {MIN_FACTORS} to {MAX_FACTORS} factors, each with '
            f'{", ".join(_NEEDED)}'
        )
    for number, entry in enumerate(entries, 1):
        _check_entry(entry, number)
    letters = _letters(entries)
    factors = [
        Factor(
            letter,
            entry['name'].strip(),
            entry['key'],
            entry['low'],
            entry['high'],
            entry.get('device'),
        )
        for letter, entry in zip(letters, entries, strict=True)
    ]
    for what in ('letter', 'name', 'key'):
        _check_different(factors, what)
    return tuple(check_levels(factor, base) for factor in factors)


def _check_entry(entry: Any, number: int) -> None:
    """Refuse an entry without the keys that a factor has, or with texts that are none."""
    if not isinstance(entry, dict):
        raise ConfigError(f'factor {number} is {quoted(entry)}, expected {", ".join(_NEEDED)}')
    name = entry.get('name')
    where = f'factor {quoted(name)}' if 'name' in entry else f'factor {number}'
    for key in _NEEDED:
        if key not in entry:
            raise ConfigError(f'{where}: no {key}, expected {", ".join(_NEEDED)}')
    for key in entry:
        if key not in (*_NEEDED, *_OPTIONAL):
            raise ConfigError(
                f'{where}: unknown entry {quoted(key)}, expected '
                f'{", ".join((*_NEEDED, *_OPTIONAL))}'
            )
    for key in ('name', 'key', 'device', 'letter'):
        text = entry.get(key)
        if key in entry and not (isinstance(text, str) and text.strip() and text.isprintable()):
            raise ConfigError(f'{where}: {key} is {quoted(text)}, expected a text of one line')
    if len(entry['name']) > _LONGEST:
        raise ConfigError(
            f'{where}: name of {len(entry["name"])} letters, expected {_LONGEST} at most'
        )
    letter = entry.get('letter', 'A')
    if letter not in tuple(LETTERS):
        raise ConfigError(f'{where}: letter {quoted(letter)}, expected one of {LETTERS}')


def _letters(entries: Sequence[dict[str, Any]]) -> list[str]:
    """Return a letter per entry: as given, or of its sensor, or the first that is free."""
    given = [entry.get('letter') for entry in entries]
    for place, entry in enumerate(entries):
        own = entry['key'].removeprefix(OBSERVATIONS)
        if given[place] is None and entry['key'] == f'{OBSERVATIONS}{own}' and own not in given:
            given[place] = own if own in tuple(LETTERS) else None
    free = iter([letter for letter in LETTERS if letter not in given])
    return [letter or next(free) for letter in given]


def _check_different(factors: Sequence[Factor], what: str) -> None:
    seen: dict[str, Factor] = {}
    for factor in factors:
        value = getattr(factor, what)
        if value in seen:
            raise ConfigError(
                f'factor {factor.name!r}: {what} {value} is also that of factor '
                f'{seen[value].name!r}, expected another one for each'
            )
        seen[value] = factor
