# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The variables that an action of a launch file sees, and how its attributes are evaluated."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import overload

from ros2_mini.errors import CommandError
from ros2_mini.launch.document import Element
from ros2_mini.launch.functions import Context, as_bool, evaluate
from ros2_mini.launch.substitutions import SubstitutionError, Template, parse


@dataclass
class Scope:
    """Launch configurations, environment and namespace at one place of a launch.

    A `<group>` works on a copy; an included file works on the scope of its `<include>`.
    """

    configurations: dict[str, str]
    environment: dict[str, str]
    parameter_directory: Path
    """Where parameters given in the launch file are written for the nodes to read."""
    namespace: str | None = None
    """Absolute namespace pushed so far; None when there is none."""
    files: tuple[Path, ...] = field(default=())
    """The files being expanded, outermost first."""

    def copy(self) -> 'Scope':
        """Return a scope whose changes do not reach this one."""
        return Scope(
            dict(self.configurations),
            dict(self.environment),
            self.parameter_directory,
            self.namespace,
            self.files,
        )

    def evaluate(self, element: Element, template: Template) -> str:
        """Return the text of a template that stands on `element`.

        Raises:
            CommandError: If a substitution in it has no value; the message says where it stands.
        """
        context = Context(self.configurations, self.environment, element.file)
        try:
            return evaluate(template, context)
        except SubstitutionError as error:
            raise CommandError(f'{element.where}: {error}') from error

    @overload
    def text(self, element: Element, name: str) -> str: ...
    @overload
    def text(self, element: Element, name: str, default: str) -> str: ...
    @overload
    def text(self, element: Element, name: str, default: None) -> str | None: ...
    def text(self, element: Element, name: str, default: str | None = '') -> str | None:
        """Return an attribute with its substitutions made, or `default` where it is absent."""
        if name not in element.attributes:
            return default
        return self.evaluate(element, template_of(element, name))

    def flag(self, element: Element, name: str, default: bool) -> bool:
        """Return an attribute that says true or false."""
        text = self.text(element, name, str(default))
        try:
            return as_bool(text)
        except SubstitutionError as error:
            raise CommandError(f'{element.where} {name}: {error}') from error

    def number(self, element: Element, name: str, default: float) -> float:
        """Return an attribute that is a number of seconds or of times."""
        text = self.text(element, name, str(default))
        try:
            return float(text)
        except ValueError as error:
            raise CommandError(f"{element.where} {name}: '{text}' is no number") from error

    def wants(self, element: Element) -> bool:
        """Say whether the element's `if` or `unless` lets it act."""
        return self.flag(element, 'if', True) and not self.flag(element, 'unless', False)


def template_of(element: Element, name: str) -> Template:
    """Return an attribute, split into text and substitutions.

    Raises:
        CommandError: If a substitution in it is malformed.
    """
    try:
        return parse(element.attributes[name])
    except SubstitutionError as error:
        raise CommandError(f'{element.where} {name}: {error}') from error
