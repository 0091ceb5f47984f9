# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Holds the text of a specification to the keys and values that there are."""

from collections.abc import Callable, Mapping
from dataclasses import asdict, fields
from functools import cache
from typing import Any, TypeVar

from hexapod_sim.article import article
from hexapod_sim.quality import grades
from pydantic import TypeAdapter, ValidationError

from hexapod_agent.algorithms import ALGORITHMS
from hexapod_agent.specification.spec_text import ConfigError, merged, quoted

T = TypeVar('T')
# One takes longer to make than to use.
_adapter: Callable[[Any], TypeAdapter[Any]] = cache(TypeAdapter)

# Sections of the layout before there was one for the learner, of bags and checkpoints.
_OF_THE_LEARNER = ('actor', 'critic', 'ddpg', 'noise')
# Switches of learners that trials have shown no use of (docs/learning.md). Specifications of bags,
# plans and agents have them, and may where they are off.
_GONE = (
    ('actor', 'layer_norm'),
    ('critic', 'layer_norm'),
    ('critic', 'twin'),
    ('ddpg', 'normalize_observations'),
)
_LAST_WITH_THEM = 'd8a52fe'


def validated(kind: type[T], values: Any, source: str, prefix: str = '') -> T:
    """Make a section of its values."""
    try:
        found: T = _adapter(kind).validate_python(values)
        return found
    except ValidationError as error:
        first = error.errors()[0]
        key = prefix + '.'.join(str(part) for part in first['loc'])
        raise ConfigError(
            f'{source}: {key} is {quoted(first["input"])}, expected: {first["msg"]}'
        ) from error


def with_algorithm(
    base: Mapping[str, Any], changes: Mapping[str, Any], source: str
) -> Mapping[str, Any]:
    """Return a base with the learner's sections of the algorithm that changes choose.

    Sections that both algorithms have stay as they are.
    """
    learner, held = changes.get('learner'), base['learner']
    chosen = held['algorithm']
    if isinstance(learner, Mapping):
        chosen = learner.get('algorithm', chosen)
    if chosen == held['algorithm']:
        return base
    if not isinstance(chosen, str) or chosen not in ALGORITHMS:
        known = ', '.join(ALGORITHMS)
        raise ConfigError(
            f'{source}: learner.algorithm is {quoted(chosen)}, expected one of {known}'
        )
    held = article()['learner'] | held
    sections = {}
    for each in fields(ALGORITHMS[chosen].config):
        default: Any = each.default
        sections[each.name] = held[each.name] if each.name in held else asdict(default)
    return {**base, 'learner': sections | {'algorithm': chosen}}


def with_grade(base: Mapping[str, Any], changes: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return a base with the sensors of the grade that changes choose.

    Values of the base that differ from its own grade were chosen one by one, and stay.
    """
    chosen, known = changes.get('quality'), grades()
    if not isinstance(chosen, str) or chosen not in known or chosen == base['quality']:
        return base
    old, new = known[base['quality']], known[chosen]
    sensors = {
        key: {
            name: vars(new[key])[name] if value == vars(old[key])[name] else value
            for name, value in values.items()
        }
        for key, values in base['sensors'].items()
    }
    return {**base, 'quality': chosen, 'sensors': sensors}


def modern(changes: Mapping[str, Any]) -> dict[str, Any]:
    """Return changes in today's layout: a learner's own sections stand in its section."""
    moved = {name: changes[name] for name in _OF_THE_LEARNER if name in changes}
    if not moved:
        return dict(changes)
    kept = {name: value for name, value in changes.items() if name not in moved}
    return merged(kept, {'learner': moved})


def without_gone(changes: Mapping[str, Any], source: str) -> Mapping[str, Any]:
    """Return changes without the switches that are gone.

    Raises:
        ConfigError: One is on.
    """
    learner = changes.get('learner')
    if not isinstance(learner, Mapping):
        return changes
    kept = dict(learner)
    for section, key in _GONE:
        held = kept.get(section)
        if not isinstance(held, Mapping) or key not in held:
            continue
        if held[key] is not False:
            raise ConfigError(
                f'{source}: learner.{section}.{key} is {quoted(held[key])}, expected false or '
                f'nothing: the switch is gone, commit {_LAST_WITH_THEM} was the last to have it'
            )
        kept[section] = {name: value for name, value in held.items() if name != key}
    return {**changes, 'learner': kept}


def check_keys(base: Mapping[str, Any], changes: Any, source: str, prefix: str) -> None:
    """Refuse keys that the base, or a section of it, does not have."""
    if not isinstance(changes, Mapping):
        raise ConfigError(f'{source}: {prefix.rstrip(".")} is {quoted(changes)}, expected keys')
    for key, value in changes.items():
        if key not in base:
            unknown, known = quoted(f'{prefix}{key}'), ', '.join(base)
            raise ConfigError(f'{source}: unknown key {unknown}, expected one of {known}')
        if isinstance(base[key], Mapping):
            check_keys(base[key], value, source, f'{prefix}{key}.')
