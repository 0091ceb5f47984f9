# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The specification of a run: everything that decides its results, apart from its seed.

article.yaml holds every value with its origin. A file of one's own names only what it changes.
YAML is the text form; a dotted key such as 'learner.actor.learning_rate' names one value.
"""

from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import yaml
from hexapod_sim.article import ARTICLE, article
from hexapod_sim.quality import Grade, Quality
from hexapod_sim.quality import check as check_qualities
from hexapod_sim.scenes.table import SceneConfig, check_walk
from hexapod_sim.sensor_table import LETTERS, SENSORS
from hexapod_sim.task_config import TaskConfig
from hexapod_sim.variations.table import RobotConfig
from hexapod_sim.world import World
from pydantic import TypeAdapter

from hexapod_agent.algorithms import ALGORITHMS
from hexapod_agent.algorithms.learner import LearnerConfig
from hexapod_agent.specification.observation import ObservationSpec, parse_observations
from hexapod_agent.specification.sections import CpgConfig, TrainingConfig
from hexapod_agent.specification.spec_text import (
    ConfigError,
    changes_of,
    flat,
    merged,
    nest,
    parsed_setting,
    read_changes,
)
from hexapod_agent.specification.validation import (
    check_keys,
    modern,
    validated,
    with_algorithm,
    with_grade,
    without_gone,
)


@dataclass(frozen=True)
class RunSpec:
    """A run's specification, frozen and nested.

    Attributes:
        observations: Whether the agent observes a channel, by its letter in the sensor table.
        quality: Grade of the devices; what `sensors` says of one goes before it.
        sensors: How good a channel's device is, by its key in the sensor table.
        scene: The ground.
        robot: How the robot varies.
        task: Reward, starts and limits.
        cpg: The pattern generator.
        learner: Algorithm and hyper-parameters.
        training: The run around the updates.
    """

    observations: Mapping[str, bool]
    quality: Grade
    sensors: Mapping[str, Quality]
    scene: SceneConfig
    robot: RobotConfig
    task: TaskConfig
    cpg: CpgConfig
    learner: LearnerConfig
    training: TrainingConfig

    @property
    def letters(self) -> str:
        """Letters of the observed channels, sorted."""
        return ''.join(sorted(letter for letter, on in self.observations.items() if on))

    @property
    def world(self) -> World:
        """What its physics is made of."""
        return World(self.scene, self.robot)

    @property
    def observed(self) -> ObservationSpec:
        """What the agent observes, and in which order."""
        return ObservationSpec(self.letters)

    def to_mapping(self) -> dict[str, Any]:
        """Return nested plain values, as `from_mapping` takes them."""
        values = asdict(self)
        values['observations'] = dict(self.observations)
        return values

    def to_text(self) -> str:
        """Return the YAML text, as `from_text` takes it."""
        plain = TypeAdapter(dict[str, Any]).dump_python(self.to_mapping(), mode='json')
        return yaml.safe_dump(plain, sort_keys=False)

    def differences(self, other: 'RunSpec') -> dict[str, tuple[Any, Any]]:
        """Return the values of both, this one's first, by the dotted keys in which they differ."""
        mine, its = flat(self.to_mapping()), flat(other.to_mapping())
        return {
            key: (mine.get(key), its.get(key))
            for key in mine | its
            if mine.get(key) != its.get(key)
        }

    @classmethod
    def from_mapping(cls, changes: Mapping[str, Any], source: str) -> 'RunSpec':
        """Build a specification from article.yaml with some values changed.

        Args:
            changes: Sections with the keys to change; `observations` may be letters.
            source: Where they come from, for messages.

        Raises:
            ConfigError: A section or key is unknown, or a value is not what it expects.
        """
        return _build(_base(), changes, source)

    @classmethod
    def from_text(cls, text: str, source: str) -> 'RunSpec':
        """Read YAML that changes values of article.yaml.

        Raises:
            ConfigError: As for `from_mapping`, or it is not YAML.
        """
        return cls.from_mapping(changes_of(text, source), source)

    @classmethod
    def load(cls, path: str | Path | None = None, settings: Iterable[str] = ()) -> 'RunSpec':
        """Read a file that changes values of article.yaml; without one, article.yaml itself.

        Args:
            path: The file.
            settings: Further changes, each as 'key=value' with a dotted key and a YAML value.

        Raises:
            ConfigError: The file is missing, is not YAML, or holds something unknown.
        """
        spec = cls.from_mapping(read_changes(path) if path else {}, str(path or ARTICLE))
        return spec.with_settings(settings)

    def changed_by(self, path: str | Path) -> 'RunSpec':
        """Read a file that changes values of this specification.

        Raises:
            ConfigError: As for `load`.
        """
        return self.changed(read_changes(path), str(path))

    def changed_by_text(self, text: str, source: str) -> 'RunSpec':
        """Read YAML that changes values of this specification, as `from_text` does."""
        return self.changed(changes_of(text, source), source)

    def changed(self, changes: Mapping[str, Any], source: str) -> 'RunSpec':
        """Build a specification from this one with some values changed, as `from_mapping` does."""
        return _build(self.to_mapping(), changes, source)

    def with_settings(self, settings: Iterable[str]) -> 'RunSpec':
        """Return a specification with single values changed, each given as 'key=value'.

        Raises:
            ConfigError: A text is not of this form, a key is unknown, or a value is not allowed.
        """
        spec, sources = self, []
        # They decide what other keys there are, or what these are where nothing is said of them.
        first = 'learner.algorithm=', 'quality='
        for setting in sorted(settings, key=lambda each: not each.startswith(first)):
            sources.append(f'--set {setting}')
            changes = nest(*parsed_setting(setting))
            spec = _built(spec.to_mapping(), changes, sources[-1])
        return _checked(spec, ' '.join(sources)) if sources else self  # together, in any order

    def with_value(self, key: str, value: Any, source: str) -> 'RunSpec':
        """Return a specification with one value changed, by its dotted key.

        Raises:
            ConfigError: The key is unknown, or the value is not allowed.
        """
        return self.changed(nest(key, value), source)

    def value(self, key: str) -> Any:
        """Return one value by its dotted key.

        Raises:
            ConfigError: The key is unknown.
        """
        values = flat(self.to_mapping())
        found = key if key in values else f'learner.{key}'  # as keys were before
        if found not in values:
            raise ConfigError(f'unknown key {key!r}, expected one of {", ".join(values)}')
        return values[found]

    def observing(self, letters: str) -> 'RunSpec':
        """Return this specification with another set of observed channels.

        Raises:
            ValueError: A letter names no channel.
        """
        return self.changed({'observations': parse_observations(letters)}, 'observations')


def _base() -> dict[str, Any]:
    """Return the values of article.yaml, what it says of each channel spread over them all."""
    values = dict(article())
    values['observations'] = dict.fromkeys(LETTERS, values['observations']['each'])
    values['sensors'] = dict.fromkeys(SENSORS, values['sensors']['each'])
    return values


def _build(base: Mapping[str, Any], changes: Any, source: str) -> RunSpec:
    """Validate a base with changes.

    Raises:
        ConfigError: See `RunSpec.from_mapping`.
    """
    return _checked(_built(base, changes, source), source)


def _built(base: Mapping[str, Any], changes: Any, source: str) -> RunSpec:
    """Validate each value of a base with changes."""
    if not isinstance(changes, Mapping):
        raise ConfigError(f'{source}: expected sections with keys, as article.yaml has them')
    changes = without_gone(modern(changes), source)
    if isinstance(changes.get('observations'), str):
        chosen = parse_observations(changes['observations'])
        changes['observations'] = {letter: letter in chosen for letter in LETTERS}
    base = with_grade(with_algorithm(base, changes, source), changes)
    check_keys(base, changes, source, '')
    values = merged(base, changes)
    learner = validated(
        ALGORITHMS[values['learner']['algorithm']].config, values['learner'], source, 'learner.'
    )
    return validated(RunSpec, values | {'learner': learner}, source)


def _checked(spec: RunSpec, source: str) -> RunSpec:
    """Return a specification whose values go with one another."""
    try:
        spec.learner.check()
        _check_precision(spec)
        check_qualities(spec.sensors)
        check_walk(spec.scene, spec.task.farthest)
    except ValueError as error:
        raise ConfigError(f'{source}: {error}') from error
    return spec


def _check_precision(spec: RunSpec) -> None:
    """Refuse arithmetic that the algorithm does not have."""
    if spec.training.precision == 'bfloat16' and not spec.learner.has_bfloat16:
        raise ValueError(
            f"training.precision is 'bfloat16', which learner.algorithm {spec.learner.algorithm} "
            "does not compute with; expected 'float32', 'float32_fast' or 'auto'"
        )
