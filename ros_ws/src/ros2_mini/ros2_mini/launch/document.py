# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Read a launch file into elements that know their line, holding it against the supported tags."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from xml.parsers import expat

from ros2_mini.errors import CommandError


@dataclass(frozen=True)
class Element:
    """One XML element of a launch file."""

    tag: str
    attributes: dict[str, str]
    file: Path
    line: int
    children: list['Element'] = field(default_factory=list)

    @property
    def where(self) -> str:
        """Where the element stands, for error messages: `file:line: <tag>`."""
        return f'{self.file}:{self.line}: <{self.tag}>'

    def nested(self, tag: str) -> list['Element']:
        """Return the direct children with that tag."""
        return [child for child in self.children if child.tag == tag]


@dataclass(frozen=True)
class Rule:
    """What one tag may hold: attributes it needs, attributes it may have, tags below it."""

    needs: tuple[str, ...] = ()
    may: tuple[str, ...] = ()
    tags: tuple[str, ...] = ()


ACTIONS = (
    'arg',
    'group',
    'include',
    'node',
    'push_ros_namespace',
    'push-ros-namespace',
    'set_env',
)
_CONDITION = ('if', 'unless')

RULES: dict[str, Rule] = {
    'launch': Rule(tags=ACTIONS),
    'arg': Rule(('name',), ('default', 'description')),
    'group': Rule(tags=ACTIONS),
    'include': Rule(('file',), (), ('arg',)),
    'node': Rule(('pkg', 'exec'), ('name', 'namespace', 'on_exit', 'output'), ('param', 'remap')),
    'push_ros_namespace': Rule(('namespace',)),
    'push-ros-namespace': Rule(('namespace',)),
    'set_env': Rule(('name', 'value')),
}
# Tags that are no actions, by the tag they stand in; no condition may stand on them.
NESTED: dict[tuple[str, str], Rule] = {
    ('include', 'arg'): Rule(('name', 'value')),
    ('node', 'param'): Rule((), ('from', 'name', 'type', 'value')),
    ('node', 'remap'): Rule(('from', 'to')),
}


def read_launch_file(path: Path) -> Element:
    """Return the root element of a launch file in which every tag and attribute is supported.

    Raises:
        CommandError: If the file cannot be read, is not XML, or holds what is not supported.
    """
    root = _parse(path)
    if root.tag != 'launch':
        raise CommandError(f'{root.where} is the root, expected <launch>')
    _check(root, RULES['launch'])
    return root


def _parse(path: Path) -> Element:
    open_elements: list[Element] = []
    roots: list[Element] = []
    parser = expat.ParserCreate()

    def start(tag: str, attributes: dict[str, str]) -> None:
        element = Element(tag, attributes, path, parser.CurrentLineNumber)
        (open_elements[-1].children if open_elements else roots).append(element)
        open_elements.append(element)

    parser.StartElementHandler = start
    parser.EndElementHandler = lambda tag: open_elements.pop()
    try:
        parser.Parse(path.read_bytes(), True)
    except OSError as error:
        raise CommandError(f"cannot read launch file '{path}': {error.strerror}") from error
    except expat.ExpatError as error:
        raise CommandError(
            f'{path}:{error.lineno}: not a launch file in XML, the only format supported: '
            f'{expat.ErrorString(error.code)}'
        ) from error
    return roots[0]


def _check(element: Element, rule: Rule) -> None:
    for child in element.children:
        if child.tag not in rule.tags:
            raise CommandError(f'{child.where} is not supported {_inside(element, rule.tags)}')
        nested = NESTED.get((element.tag, child.tag))
        _check_attributes(child, nested or RULES[child.tag], () if nested else _CONDITION)
        _check(child, nested or RULES[child.tag])


def _check_attributes(element: Element, rule: Rule, conditions: tuple[str, ...]) -> None:
    known = (*rule.needs, *rule.may, *conditions)
    for name in element.attributes:
        if name not in known:
            raise CommandError(
                f"{element.where} has an attribute '{name}' that is not supported; "
                f'supported: {_listed(known)}'
            )
    for name in rule.needs:
        if name not in element.attributes:
            raise CommandError(f"{element.where} needs the attribute '{name}'")
    if {'if', 'unless'} <= element.attributes.keys():
        raise CommandError(f"{element.where} has both 'if' and 'unless', expected one")


def _inside(parent: Element, tags: Iterable[str]) -> str:
    return f'in <{parent.tag}>; supported: {_listed(tags)}'


def _listed(names: Iterable[str]) -> str:
    return ', '.join(sorted(names)) or 'nothing'
