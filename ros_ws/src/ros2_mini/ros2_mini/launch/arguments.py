# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Launch arguments: those given on the command line, and those that a file declares."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ros2_mini.errors import CommandError
from ros2_mini.launch.document import Element, read_launch_file
from ros2_mini.launch.scope import template_of
from ros2_mini.launch.substitutions import Substitution, SubstitutionError, Template, evaluate


def parse_launch_arguments(words: Sequence[str]) -> dict[str, str]:
    """Return the value of each `name:=value`; the last one wins.

    Raises:
        CommandError: If a word has another form, or no value.
    """
    arguments = {}
    for word in words:
        name, separator, value = word.partition(':=')
        if not name or not separator or not value:
            raise CommandError(
                f"malformed launch argument '{word}', expected format '<name>:=<value>'"
            )
        arguments[name] = value
    return arguments


@dataclass(frozen=True)
class Declaration:
    """An `<arg>` that a launch file, or one that it includes, declares."""

    name: str
    description: str
    default: Template | None
    conditional: bool

    def __str__(self) -> str:
        star = '*' if self.conditional else ''
        text = f"    '{self.name}':{star}\n        {self.description}"
        if self.default is None:
            return text
        return f'{text}\n        (default: {describe(self.default)})'


def declarations(path: Path) -> list[Declaration]:
    """Return the arguments that a launch file declares, each name once.

    A file included under a name that depends on the arguments is left out.
    """
    found: dict[str, Declaration] = {}
    _collect(read_launch_file(path.absolute()), False, found)
    return list(found.values())


def _collect(element: Element, conditional: bool, found: dict[str, Declaration]) -> None:
    for child in element.children:
        depends = conditional or bool({'if', 'unless'} & child.attributes.keys())
        if child.tag == 'arg':
            declaration = _declaration(child, depends)
            found.setdefault(declaration.name, declaration)
        elif child.tag == 'group':
            _collect(child, depends, found)
        elif child.tag == 'include' and (path := _fixed_path(child)):
            _collect(read_launch_file(path), depends, found)


def _declaration(arg: Element, conditional: bool) -> Declaration:
    description = arg.attributes.get('description', 'no description given')
    default = template_of(arg, 'default') if 'default' in arg.attributes else None
    return Declaration(arg.attributes['name'], description, default, conditional)


def _fixed_path(include: Element) -> Path | None:
    """Return the file of an `<include>` if it depends on no launch configuration."""
    try:
        return Path(evaluate(template_of(include, 'file'), {}, include.file))
    except SubstitutionError:
        return None


_CLASSES = {
    'dirname': 'ThisLaunchFileDir',
    'find-pkg-share': 'FindPackageShare',
    'var': 'LaunchConfig',
}


def describe(template: Template) -> str:
    """Return a template in the words of the launch library: text quoted, `+` between pieces."""
    pieces = template or ('',)
    return ' + '.join(
        f"'{piece}'" if isinstance(piece, str) else _describe_one(piece) for piece in pieces
    )


def _describe_one(substitution: Substitution) -> str:
    name = _CLASSES.get(substitution.name, substitution.name)
    argument = describe(substitution.arguments[0]) if substitution.arguments else ''
    keyword = 'pkg=' if name.startswith('FindPackage') else ''
    return f'{name}({keyword}{argument})'
