# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What a study of configurations trains, as read from its file."""

import itertools
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import yaml
from hexapod_agent.specification.observation import parse_observations
from hexapod_agent.specification.run_spec import ConfigError, RunSpec
from pydantic import PositiveInt, TypeAdapter, ValidationError

NONE = 'none'  # the set of no optional sensor, in the table and on the command line
JUDGEMENT_SEED = 1  # of the starts, as `evaluate` has it; no training may have it
_COLUMNS = (
    'sensors', 'seed', 'episode', 'starts', 'return', 'offset', 'speed', 'falls',
    'training_return', 'cpu_s', 'commit',
)  # fmt: skip


@dataclass(frozen=True)
class Factor:
    """What the two levels of a factor set: values by 'section.key' of a configuration."""

    low: dict[str, Any]
    high: dict[str, Any]


@dataclass(frozen=True)
class Study:
    """What to train.

    Attributes:
        sets: Letters of each set of sensors.
        seeds: Common to all sets and rows; 1 is that of the judgement.
        episodes: Length of each training.
        judged_after: Episodes after which the agent is evaluated; the last one always is.
        starts: Of an evaluation.
        config: File of changes to article.yaml that all rows have, beside the study's file.
        base: Values by dotted key that all rows have.
        factors: By name.
        rows: A sign per factor; one row without factors is the base itself.
    """

    sets: tuple[str, ...]
    seeds: tuple[PositiveInt, ...]
    episodes: PositiveInt
    judged_after: tuple[PositiveInt, ...] = ()
    starts: PositiveInt = 20
    config: str | None = None
    base: dict[str, Any] = field(default_factory=dict)
    factors: dict[str, Factor] = field(default_factory=dict)
    rows: tuple[str, ...] = ('',)

    @classmethod
    def load(cls, path: Path) -> 'Study':
        """Read and check a study's file.

        Raises:
            ConfigError: It is missing or no study, or a row's configuration cannot be used.
        """
        if not path.is_file():
            raise ConfigError(f'study {str(path)!r} not found, expected a YAML file')
        try:
            study = TypeAdapter(cls).validate_python(yaml.safe_load(path.read_text('utf-8')))
        except (yaml.YAMLError, ValidationError) as error:
            raise ConfigError(f'study {str(path)!r}: {error}') from error
        if study.config:
            study = replace(study, config=str(path.parent / study.config))
        study._check(path)
        return study

    def _check(self, path: Path) -> None:
        """Refuse what would not train, before anything does."""
        if JUDGEMENT_SEED in self.seeds:
            raise ConfigError(
                f'study {str(path)!r}: seed {JUDGEMENT_SEED} is that of the starts that agents '
                'are judged from, expected others'
            )
        for row in self.rows:
            if len(row) != len(self.factors) or set(row) - {'+', '-'}:
                raise ConfigError(
                    f'study {str(path)!r}: row {row!r}, expected {len(self.factors)} signs + or '
                    '-, one for each factor'
                )
            self.configuration(row)
        for sensors in self.sets:
            parse_observations(letters_of(sensors))

    def values(self, row: str) -> dict[str, Any]:
        """Values by dotted key that make a row."""
        levels = [
            factor.high if sign == '+' else factor.low
            for factor, sign in zip(self.factors.values(), row, strict=True)
        ]
        return {key: value for level in (self.base, *levels) for key, value in level.items()}

    @property
    def keys(self) -> list[str]:
        """Dotted keys that any row sets."""
        return sorted({key for row in self.rows for key in self.values(row)})

    @property
    def columns(self) -> list[str]:
        """Names of the table's columns."""
        return ['row', *self.keys, *_COLUMNS]

    def configuration(self, row: str) -> RunSpec:
        """Build what a row trains with; its length is that of the trainings."""
        config = RunSpec.load(self.config)
        for key, value in self.values(row).items():
            config = config.with_value(key, value, f'row {row!r}')
        return config.with_value('training.episodes', self.episodes, 'episodes')

    def runs(self) -> list['Run']:
        """Every training, those of a seed together."""
        combinations = itertools.product(self.seeds, self.rows, self.sets)
        return [Run(row, letters, seed) for seed, row, letters in combinations]


@dataclass(frozen=True)
class Run:
    """One training of a study."""

    row: str
    sensors: str
    seed: int


def letters_of(sensors: str) -> str:
    """Letters of a set as the table names it."""
    return '' if sensors == NONE else sensors
