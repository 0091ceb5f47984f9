# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The YAML text of changes to a specification, from a file, an option or a goal, and its keys."""

import reprlib
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import yaml
from hexapod_sim.article import article
from hexapod_sim.command_line import CommandLine, file

_MOST_CHARACTERS, _MOST_BRACKETS = 20_000, 500
_QUOTES = reprlib.Repr()
_QUOTES.maxstring = _QUOTES.maxother = 200


def flat(mapping: Mapping[str, Any], prefix: str = '') -> dict[str, Any]:
    """Return nested values by their dotted keys."""
    values: dict[str, Any] = {}
    for key, value in mapping.items():
        nested = flat(value, f'{prefix}{key}.') if isinstance(value, Mapping) else None
        values |= nested if nested is not None else {f'{prefix}{key}': value}
    return values


def merged(base: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """Return `base` with the values of `changes`, section by section."""
    found = dict(base)
    for key, value in changes.items():
        nested = isinstance(value, Mapping) and isinstance(found.get(key), Mapping)
        found[key] = merged(found[key], value) if nested else value
    return found


def nest(key: str, value: Any) -> dict[str, Any]:
    """Return the one value of a dotted key as nested values."""
    *sections, name = key.split('.')
    found = {name: value}
    for section in reversed(sections):
        found = {section: found}
    return found


class ConfigError(ValueError):
    """A specification cannot be used; the message names file, key and expectation."""


def quoted(value: Any) -> str:
    """Return a value for a message, cut where it is long or deep."""
    return _QUOTES.repr(value)


def parsed(text: str, source: str, aliases: bool = True) -> Any:
    """Parse YAML.

    Args:
        text: to parse.
        source: where it comes from, for messages.
        aliases: whether a value may refer to another one.

    Raises:
        ConfigError: It is not YAML, has a key twice, or has an alias and must not.
    """
    try:
        if not aliases and any(isinstance(event, yaml.AliasEvent) for event in yaml.parse(text)):
            raise ConfigError(f"{source}: an alias ('*'), expected every value written out")
        return yaml.load(text, _WithoutDoubles)
    except ConfigError:
        raise
    # A day that there is not, a number of thousands of digits and a bracket within a thousand
    # others are errors of other kinds.
    except (yaml.YAMLError, ValueError, OverflowError, RecursionError) as error:
        raise ConfigError(f'{source}: not YAML: {" ".join(str(error).split())}') from error


def changes_of(text: str, source: str) -> dict[str, Any]:
    """Parse the text of changes that somebody sent; an empty one changes nothing.

    Whoever is in the ROS domain may send one: a value that refers to another one could be of any
    size once it is read, and brackets within brackets take ever longer to read.

    Raises:
        ConfigError: It is not YAML or has no sections with keys, is too long, or has an alias.
    """
    if len(text) > _MOST_CHARACTERS:
        raise ConfigError(f'{source}: {len(text)} characters, expected at most {_MOST_CHARACTERS}')
    brackets = text.count('[') + text.count('{')
    if brackets > _MOST_BRACKETS:
        raise ConfigError(f'{source}: {brackets} brackets, expected at most {_MOST_BRACKETS}')
    return _sections(parsed(text, source, aliases=False), source)


def read_changes(path: str | Path) -> dict[str, Any]:
    """Read a file of changes.

    Raises:
        ConfigError: The file is missing, is not YAML, or has no sections with keys.
    """
    named = Path(path).expanduser()
    if not named.is_file():
        raise ConfigError(
            f'config file {str(path)!r} not found, expected a YAML file with sections of '
            f'{", ".join(article())}'
        )
    try:
        text = named.read_text(encoding='utf-8')
    except UnicodeDecodeError as error:
        raise ConfigError(f'{path}: not YAML: not UTF-8 text') from error
    return _sections(parsed(text, str(path)), str(path))


def parsed_setting(setting: str) -> tuple[str, Any]:
    """Return key and value of 'key=value'.

    Raises:
        ConfigError: It has another form, or its value is not YAML.
    """
    key, mark, value = setting.partition('=')
    if not (key and mark):
        raise ConfigError(f'--set {setting}: expected key=value, such as task.line_y=0.1')
    return key, parsed(value, f'--set {setting}')


def changes_text(path: str | Path | None, settings: Iterable[str]) -> str:
    """Return the changes of a file and of 'key=value' settings as one text.

    Raises:
        ConfigError: As for `read_changes` and `parsed_setting`.
    """
    changes = read_changes(path) if path else {}
    for setting in settings:
        changes = merged(changes, nest(*parsed_setting(setting)))
    return yaml.dump(changes, Dumper=_WithoutAliases, sort_keys=False)


def add_spec_options(parser: CommandLine) -> None:
    """Give a command line the options that say what a run is, for `RunSpec.load`."""
    parser.add_argument(
        '--config',
        '--hyperparameters',  # its name before the sensors were in it
        type=file,
        metavar='FILE',
        help='YAML file of changes to article.yaml',
    )
    parser.add_argument(
        '--set',
        action='append',
        default=[],
        metavar='KEY=VALUE',
        help='one further change, such as learner.actor.learning_rate=2e-4; may be repeated',
    )


class _WithoutDoubles(yaml.SafeLoader):
    """Refuses a key that a section has twice, of which YAML would lose the first."""

    def construct_mapping(self, node: yaml.MappingNode, deep: bool = False) -> dict[Any, Any]:
        keys = [key.value for key, _ in node.value if isinstance(key, yaml.ScalarNode)]
        for twice in (key for key in keys if keys.count(key) > 1):
            raise yaml.constructor.ConstructorError(
                None, None, f'key {quoted(twice)} twice in one section', node.start_mark
            )
        return super().construct_mapping(node, deep)


class _WithoutAliases(yaml.SafeDumper):
    def ignore_aliases(self, data: Any) -> bool:  # each value is written out
        return True


def _sections(values: Any, source: str) -> dict[str, Any]:
    values = values or {}
    if not isinstance(values, Mapping):
        raise ConfigError(f'{source}: expected sections with keys, as article.yaml has them')
    return dict(values)
