# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Tables of every key of a run's specification, for docs/specification.md.

Values and their origins are those of article.yaml and its comments; meanings, units and ranges
those of the dataclasses that check them.
"""

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, fields, is_dataclass
from types import NoneType
from typing import Annotated, Any, Literal, get_args, get_origin, get_type_hints

import yaml
from hexapod_agent.algorithms import ALGORITHMS
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_agent.specification.spec_text import flat
from hexapod_node.parameters import field_docs
from hexapod_sim.article import article_text
from hexapod_sim.quality import Quality
from hexapod_sim.sensor_table import CHANNELS, SENSORS

HEAD = ('key', 'value', 'unit', 'allowed', 'meaning', 'origin of the value')
_LINE = re.compile(r'^( *)(\w+):([^#]*)(?:# ?(.*))?$')
_ORIGIN = re.compile(r'\[(article|source|ours)\] ?')
_UNITS = {
    '1/s', '1/sqrt(s)', 'Hz', 'episodes', 'kg', 'm', 'm/s', 'per step', 'rad', 'rad/s', 's',
    'steps', 'updates', 'updates per step',
}  # fmt: skip
_UNIT = re.compile(r' ?\[((?:[a-z1²/·() ]|N|Hz)+)\]')


@dataclass(frozen=True)
class Comment:
    """What article.yaml says of a value."""

    unit: str = ''
    origin: str = ''


@dataclass(frozen=True)
class Key:
    """A key of a specification, as the code declares it."""

    name: str
    hint: Any
    doc: str


def specification_tables() -> str:
    """Return a heading and a table for each section of a specification, as Markdown."""
    hints = get_type_hints(RunSpec, include_extras=True)
    parts = [('observations', observations()), ('sensors', sensors(hints))]
    sections = ('scene', 'robot', 'task', 'cpg', 'training')
    parts += [(name, rows(keys(hints[name], f'{name}.'), RunSpec.load())) for name in sections]
    choice = Key('learner.algorithm', Literal[tuple(ALGORITHMS)], 'What learns.')
    parts.append(('learner', rows([choice], RunSpec.load())))
    parts += [(f'learner: {name}', learner(name)) for name in ALGORITHMS]
    return '\n\n'.join(f'## {title}\n\n{markdown(table)}' for title, table in parts)


def observations() -> list[tuple[str, ...]]:
    """Return a row for each channel that may be observed."""
    value, origin = _text(False), _comments()['observations.each'].origin
    return [
        (f'`observations.{c.letter}`', value, '', 'true, false', f'observe the {c.name}', origin)
        for c in CHANNELS
        if c.letter
    ]


def learner(algorithm: str) -> list[tuple[str, ...]]:
    """Return a row for each key that an algorithm has."""
    found = keys(ALGORITHMS[algorithm].config, 'learner.')
    spec = RunSpec.load(settings=[f'learner.algorithm={algorithm}'])
    return rows((key for key in found if key.name != 'learner.algorithm'), spec)


def sensors(hints: Mapping[str, Any]) -> list[tuple[str, ...]]:
    """Return the grade, and a row for each number of a channel's quality."""
    grade = Key('quality', hints['quality'], 'grade of all devices; `sensors` goes before it')
    found = rows([grade], RunSpec.load())
    channel = next(iter(SENSORS))
    for row in rows(keys(Quality, f'sensors.{channel}.'), RunSpec.load()):
        name = row[0].strip('`').rpartition('.')[2]
        comment = _comments()[f'sensors.each.{name}']
        unit = comment.unit or row[2]
        found.append((f'`sensors.CHANNEL.{name}`', row[1], unit, *row[3:5], comment.origin))
    return found


def keys(config: Any, prefix: str) -> Iterator[Key]:
    """Yield the keys that a configuration's fields are, those of its sections below it."""
    hints, docs = get_type_hints(config, include_extras=True), _docs(config)
    for field in fields(config):
        hint, name = hints[field.name], f'{prefix}{field.name}'
        if is_dataclass(hint):
            yield from keys(hint, f'{name}.')
        else:
            yield Key(name, hint, docs.get(field.name, ''))


def rows(found: Iterable[Key], spec: RunSpec) -> list[tuple[str, ...]]:
    """Return a row for each key of a specification."""
    values = flat(spec.to_mapping())
    table = []
    for key in found:
        comment = _comments().get(key.name, Comment())
        unit = _UNIT.search(key.doc)
        table.append(
            (
                f'`{key.name}`',
                _text(values[key.name]),
                comment.unit or (unit[1] if unit else ''),
                allowed(key.hint),
                _UNIT.sub('', key.doc).rstrip('.'),
                comment.origin,
            )
        )
    return table


def allowed(hint: Any) -> str:
    """Say what a value of this type may be."""
    if get_origin(hint) is Literal:
        return ', '.join(get_args(hint))
    if get_origin(hint) is Annotated:
        kind, *marks = get_args(hint)
        limits = [limit for mark in marks if (limit := _limits(mark))]
        return limits[0] if limits else allowed(kind)
    if get_origin(hint) is tuple:
        kinds = [kind for kind in get_args(hint) if kind is not Ellipsis]
        each = allowed(kinds[0])
        count = 'numbers' if Ellipsis in get_args(hint) else f'{len(kinds)} numbers'
        return f'{count}, each {each}' if each else count
    return {bool: 'true, false', float: '', str: '', NoneType: 'null'}.get(hint, '')


def _limits(mark: Any) -> str:
    """Say what an interval allows."""
    low, above, high = (getattr(mark, name, None) for name in ('ge', 'gt', 'le'))
    if high is None:
        return ''
    return f'{low:.15g} to {high:.15g}' if above is None else f'above {above:g}, to {high:.15g}'


def _docs(config: type) -> dict[str, str]:
    """Return what a dataclass and its bases say of their fields, below each or in a docstring."""
    docs = field_docs(config)
    for base in reversed(config.__mro__):
        _, *listed = re.split(r'\n    Attributes:\n', base.__doc__ or '')
        for text in listed:
            entries = re.findall(r'^        (\w+): (.*(?:\n          .*)*)', text, re.MULTILINE)
            docs |= {name: ' '.join(words.split()) for name, words in entries}
    return docs


def _comments() -> dict[str, Comment]:
    """Return the comments of article.yaml by dotted key; of a section where a value has none."""
    found: dict[str, Comment] = {}
    path: list[str] = []
    for indent, name, text in _commented():
        path = [*path[: indent // 2], name]
        above = found.get('.'.join(path[:-1]), Comment())
        own = comment(text)
        tagged = _ORIGIN.search(text) or not _ORIGIN.match(above.origin)
        origin = own.origin if tagged else '; '.join(filter(None, (above.origin, own.origin)))
        found['.'.join(path)] = Comment(own.unit, origin)
    return found


def _commented() -> Iterator[tuple[int, str, str]]:
    """Yield indentation, name and comment of each key, comments of several lines as one."""
    entry: list[Any] = []
    for line in article_text().splitlines():
        if key := _LINE.match(line):
            if entry:
                yield tuple(entry)
            entry = [len(key[1]), key[2], key[4] or '']
        elif entry and line.lstrip().startswith('#'):
            entry[2] += ' ' + line.lstrip('# ')
    yield tuple(entry)


def comment(text: str) -> Comment:
    """Part a comment: `m. [ours] why` is a unit, who chose the value, and the reason."""
    tag = _ORIGIN.search(text)
    before, origin = (text[: tag.start()], text[tag.start() :]) if tag else (text, '')
    unit, _, more = before.partition(',')
    if unit.strip(' .') in _UNITS:
        unit, before = unit.strip(' .'), more
    else:
        unit = ''
    return Comment(unit, ' '.join(filter(None, (origin.strip(), before.strip(' .')))))


def _text(value: Any) -> str:
    """Return a value as YAML in code."""
    plain = list(value) if isinstance(value, tuple) else value
    return f'`{yaml.safe_dump(plain, default_flow_style=True).splitlines()[0]}`'


def markdown(table: Iterable[tuple[str, ...]]) -> str:
    """Return a table under `HEAD`."""
    rows = [[cell.replace('|', '\\|') for cell in row] for row in table]
    lines = [HEAD, ('---',) * len(HEAD), *rows]
    return '\n'.join(f'| {" | ".join(line)} |' for line in lines)
