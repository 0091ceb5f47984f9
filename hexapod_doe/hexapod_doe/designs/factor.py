# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Factors of an experiment, each a key of a run's specification with two levels."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import yaml
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_agent.specification.spec_text import ConfigError, parsed, quoted
from hexapod_sim.sensor_table import CHANNELS, SENSORS

from hexapod_doe.designs.terms import letters_on
from hexapod_doe.errors import BagError

FACTORS = 'factors'
"""Where the metadata of a bag has the factors of its plan, if they are not sensors alone."""
OBSERVATIONS = 'observations.'
"""What the key of a sensor begins with."""
_SENSORS = {channel.letter: channel for channel in CHANNELS if channel.letter}


@dataclass(frozen=True)
class Factor:
    """What an experiment varies between two levels.

    Attributes:
        letter: Its name in terms and in the columns of a plan.
        name: Its name in texts.
        key: Dotted key of the specification; empty for a column of a foreign table.
        low: Value of the key at level -1.
        high: Value of the key at level +1.
        device: What has to be on the robot for the high level; None where nothing has.
    """

    letter: str
    name: str
    key: str = ''
    low: Any = False
    high: Any = True
    device: str | None = None

    @property
    def is_sensor(self) -> bool:
        """Whether it is that the channel of its letter is observed or not."""
        return self.sensor == self.letter

    @property
    def sensor(self) -> str:
        """Letter of the channel that is observed at the high level; empty for other factors."""
        own = self.key.startswith(OBSERVATIONS) and self.high is True
        return self.key.removeprefix(OBSERVATIONS) if own else ''

    def value(self, level: float) -> Any:
        """Return the value of the key at a coded level."""
        return self.high if level > 0 else self.low

    def text(self, level: float) -> str:
        """Return a level in words, such as 'yaw share 0.5' or 'body orientation on'."""
        return f'{self.name} {shown(self.value(level))}'

    @property
    def change(self) -> str:
        """From the low to the high level in words, such as 'yaw share 0 → 1'."""
        return f'{self.name} {shown(self.low)} → {shown(self.high)}'

    def entry(self) -> dict[str, Any]:
        """Return plain values, as a factor file has them."""
        values = {
            'letter': self.letter,
            'name': self.name,
            'key': self.key,
            'low': self.low,
            'high': self.high,
        }
        return values if self.device is None else values | {'device': self.device}


def shown(value: Any) -> str:
    """Return the value of a key in words: on and off for true and false."""
    if isinstance(value, bool):
        return 'on' if value else 'off'
    if isinstance(value, list | tuple):
        return '×'.join(shown(each) for each in value)
    return f'{value:g}' if isinstance(value, float) else str(value)


def default_factors(letters: Iterable[str]) -> tuple[Factor, ...]:
    """Return the sensors of some letters; a letter of no sensor has no key.

    Args:
        letters: In the order of the columns.
    """
    return tuple(
        Factor(
            letter,
            _SENSORS[letter].name,
            f'{OBSERVATIONS}{letter}',
            device=_SENSORS[letter].device,
        )
        if letter in _SENSORS
        else Factor(letter, letter)
        for letter in letters
    )


@dataclass(frozen=True)
class Treatments:
    """The factors of an experiment, and the specification that all its runs start from."""

    factors: tuple[Factor, ...]
    base: RunSpec = field(default_factory=RunSpec.load)

    def as_dict(self) -> dict[str, Any]:
        """Return plain values, as a plan's JSON file has them."""
        return {
            'factors': [factor.entry() for factor in self.factors],
            'base': yaml.safe_load(self.base.to_text()),
        }

    @cached_property
    def factors_text(self) -> str:
        """The factors as YAML, as a bag keeps them."""
        entries = self.as_dict()['factors']
        return yaml.safe_dump(entries, sort_keys=False, allow_unicode=True)

    @property
    def letters(self) -> str:
        """The letters of the factors."""
        return ''.join(factor.letter for factor in self.factors)

    @cached_property
    def default(self) -> bool:
        """Whether it is sensors alone, on top of article.yaml."""
        return self.only_sensors and self.base == RunSpec.load()

    @cached_property
    def only_sensors(self) -> bool:
        """Whether its factors are those of a plan that is told nothing else."""
        return self.factors == default_factors(self.letters)

    def label(self, levels: Sequence[float]) -> str:
        """Return the short name of a case: its factors at the high level, as they stand."""
        return letters_on(levels, self.letters) or 'none'

    def text(self, levels: Sequence[float]) -> str:
        """Return a case in words, such as 'sensors CD' or 'yaw share 1, body height off'."""
        if self.only_sensors:
            return f'sensors {self.observations(levels) or "none"}'
        pairs = zip(self.factors, levels, strict=True)
        return ', '.join(factor.text(level) for factor, level in pairs)

    @property
    def legend(self) -> tuple[str, ...]:
        """What the letters stand for, a line for each; empty for sensors alone."""
        if self.only_sensors:
            return ()
        return tuple(f'{factor.letter}  {factor.change}' for factor in self.factors)

    def observations(self, levels: Sequence[float]) -> str:
        """Return the letters of the channels that the runs of a case observe.

        A factor without a key counts as one of them.
        """
        seen: dict[str, bool] = {letter: on for letter, on in self.base.observations.items() if on}
        for factor, level in zip(self.factors, levels, strict=True):
            if factor.key.startswith(OBSERVATIONS):
                seen[factor.key.removeprefix(OBSERVATIONS)] = factor.value(level)
            elif not factor.key:
                seen[factor.letter] = level > 0
        found = [letter for letter, on in seen.items() if on]
        return ''.join(found if self.default else sorted(found))

    def unseen(self, cases: Iterable[Sequence[float]]) -> list[tuple[str, str]]:
        """Return factors of a device that no case observes: name, and the channel with its key."""
        seen = set().union(*map(self.observations, cases))
        keys = {factor.name: factor.key.split('.') for factor in self.factors}
        named = {name: SENSORS[key[1]] for name, key in keys.items() if key[0] == 'sensors'}
        return [
            (name, f'{channel.name} ({OBSERVATIONS}{channel.letter})')
            for name, channel in named.items()
            if channel.letter and channel.letter not in seen
        ]

    def spec(self, levels: Sequence[float]) -> RunSpec:
        """Return the specification of the runs of a case.

        Args:
            levels: Coded, -1 or +1, one per factor.

        Raises:
            ConfigError: A factor has no key, or a level is not allowed; the text names the
                factor, its key and what is.
        """
        for factor in self.factors:
            if not factor.key:
                raise ConfigError(
                    f'factor {factor.letter}: no key of the specification, expected one; '
                    'give a factor file to `plan --factors`'
                )
        pairs = list(zip(self.factors, levels, strict=True))
        changes: dict[str, Any] = {}
        for factor, level in pairs:
            _nest(changes, factor.key.split('.'), factor.value(level))
        source = f'factors {", ".join(f"{each.letter} {each.text(at)}" for each, at in pairs)}'
        try:
            return self.base.changed(changes, source)
        except ConfigError as error:
            for factor, level in pairs:  # one of them may be at fault by itself
                fault = self._fault_alone(factor, level)
                if fault and str(error) == f'{source}: {fault}':
                    raise ConfigError(f'factor {factor.name!r}: {fault}') from error
            raise

    def _fault_alone(self, factor: Factor, level: float) -> str:
        """Return why the base cannot have one level; empty if it can."""
        try:
            self.base.with_value(factor.key, factor.value(level), '')
        except ConfigError as error:
            return str(error).removeprefix(': ')
        return ''


def factors_in(metadata: Mapping[str, str]) -> tuple[Factor, ...] | None:
    """Return the factors that a run's bag names; None where they are sensors alone.

    Raises:
        BagError: They are no list of factors.
    """
    text = metadata.get(FACTORS)
    if text is None:
        return None
    try:
        return tuple(Factor(**entry) for entry in parsed(text, 'bag', aliases=False))
    except (ConfigError, TypeError) as error:
        raise BagError(
            f'run {metadata.get("run_id", "without a name")}: {quoted(text)} in its metadata, '
            'expected a list of factors'
        ) from error


def sensors(letters: Iterable[str]) -> Treatments:
    """Return the experiment that varies sensors on top of article.yaml."""
    return Treatments(default_factors(letters))


def _nest(changes: dict[str, Any], path: Sequence[str], value: Any) -> None:
    for part in path[:-1]:
        changes = changes.setdefault(part, {})
    changes[path[-1]] = value
