# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The configuration of a run, read from YAML: task, pattern generator and learner.

article.yaml holds every value with its origin. A file of one's own names only what it changes.
"""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields, is_dataclass
from pathlib import Path
from typing import Any, Literal, get_type_hints

import yaml
from hexapod_cpg.mapping import ActionRanges
from hexapod_cpg.oscillator import HopfConfig
from hexapod_sim.article import ARTICLE, article
from hexapod_sim.task import TaskConfig
from pydantic import TypeAdapter, ValidationError

from hexapod_agent.hyperparameters import (
    ActorConfig,
    CriticConfig,
    DdpgConfig,
    NoiseConfig,
    TrainingConfig,
)


class ConfigError(ValueError):
    """A configuration cannot be used; the message names file, key and expectation."""


@dataclass(frozen=True)
class CpgConfig:
    """The pattern generator and what an action asks of it.

    Attributes:
        hopf: Constants of the oscillators.
        reading: Which command fields the five actions of a leg set.
        ranges: What action zero and action one stand for.
    """

    hopf: HopfConfig
    reading: Literal['D1', 'D2']
    ranges: ActionRanges


@dataclass(frozen=True)
class AgentConfig:
    """Everything that decides a run, apart from its observations, seed and length."""

    task: TaskConfig
    cpg: CpgConfig
    actor: ActorConfig
    critic: CriticConfig
    ddpg: DdpgConfig
    noise: NoiseConfig
    training: TrainingConfig

    def to_mapping(self) -> dict[str, Any]:
        """Return nested plain values, as `from_mapping` takes them."""
        return asdict(self)

    def differences(self, other: 'AgentConfig') -> dict[str, tuple[Any, Any]]:
        """Return the values of both, this one's first, by the dotted keys in which they differ."""
        mine, its = _flat(self.to_mapping()), _flat(other.to_mapping())
        return {key: (mine[key], its[key]) for key in mine if mine[key] != its[key]}

    @classmethod
    def from_mapping(cls, changes: Mapping[str, Any], source: str) -> 'AgentConfig':
        """Build a configuration from article.yaml with some values changed.

        Args:
            changes: Sections with the keys to change.
            source: Where they come from, for messages.

        Raises:
            ConfigError: A section or key is unknown, or a value is not what it expects.
        """
        _check_keys(cls, changes, source, '')
        values = _merged(article(), changes)
        try:
            config: AgentConfig = TypeAdapter(cls).validate_python(values)
        except ValidationError as error:
            first = error.errors()[0]
            key = '.'.join(str(part) for part in first['loc'])
            raise ConfigError(
                f'{source}: {key} is {first["input"]!r}, expected: {first["msg"]}'
            ) from error
        try:
            _ = config.ddpg.group_size
        except ValueError as error:
            raise ConfigError(f'{source}: {error}') from error
        return config

    @classmethod
    def load(cls, path: str | Path | None = None) -> 'AgentConfig':
        """Read a file that changes values of article.yaml; without one, article.yaml itself.

        Raises:
            ConfigError: The file is missing, is not YAML, or holds something unknown.
        """
        return cls.from_mapping(_changes(path) if path else {}, str(path or ARTICLE))

    def changed_by(self, path: str | Path) -> 'AgentConfig':
        """Read a file that changes values of this configuration.

        Raises:
            ConfigError: As for `load`.
        """
        return self.changed(_changes(path), str(path))

    def changed(self, changes: Mapping[str, Any], source: str) -> 'AgentConfig':
        """Build a configuration from this one with some values changed, as `from_mapping` does."""
        return self.from_mapping(_merged(self.to_mapping(), changes), source)


def _changes(path: str | Path) -> Mapping[str, Any]:
    """Read a file of changes."""
    file = Path(path).expanduser()
    if not file.is_file():
        raise ConfigError(
            f'config file {str(path)!r} not found, expected a YAML file with sections of '
            f'{", ".join(field.name for field in fields(AgentConfig))}'
        )
    return _read(file)


def _read(path: Any) -> Mapping[str, Any]:
    """Parse a YAML file; an empty one changes nothing."""
    try:
        changes = yaml.safe_load(path.read_text(encoding='utf-8')) or {}
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        raise ConfigError(f'{path}: not YAML: {error}') from error
    if not isinstance(changes, Mapping):
        raise ConfigError(f'{path}: expected sections with keys, as article.yaml has them')
    return changes


def _check_keys(cls: type, mapping: Any, source: str, prefix: str) -> None:
    """Refuse keys that the dataclass, or a dataclass inside it, does not have."""
    if not isinstance(mapping, Mapping):
        raise ConfigError(f'{source}: {prefix or "the file"} is {mapping!r}, expected keys')
    types = get_type_hints(cls)
    known = {field.name: types[field.name] for field in fields(cls)}
    for key, value in mapping.items():
        if key not in known:
            raise ConfigError(
                f'{source}: unknown key {f"{prefix}{key}"!r}, expected one of {", ".join(known)}'
            )
        if is_dataclass(known[key]):
            _check_keys(known[key], value, source, f'{prefix}{key}.')


def _flat(mapping: Mapping[str, Any], prefix: str = '') -> dict[str, Any]:
    """Return nested values by their dotted keys."""
    values: dict[str, Any] = {}
    for key, value in mapping.items():
        nested = _flat(value, f'{prefix}{key}.') if isinstance(value, Mapping) else None
        values |= nested if nested is not None else {f'{prefix}{key}': value}
    return values


def _merged(base: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """Return `base` with the values of `changes`, section by section."""
    merged = dict(base)
    for key, value in changes.items():
        nested = isinstance(value, Mapping) and isinstance(merged.get(key), Mapping)
        merged[key] = _merged(merged[key], value) if nested else value
    return merged
