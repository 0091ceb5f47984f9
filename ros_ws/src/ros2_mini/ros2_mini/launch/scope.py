# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The variables that an action of a launch file sees, and how its attributes are evaluated."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import overload

from ros2_mini.errors import CommandError
from ros2_mini.launch.document import Element
from ros2_mini.launch.substitutions import SubstitutionError, Template, as_bool, evaluate, parse


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
    files: tuple[Path, ...] = ()
    """The files being expanded, outermost first."""

    def copy(self) -> 'Scope':
        """Return a scope whose changes do not reach this one."""
        return replace(
            self,
            configurations=dict(self.configurations),
            environment=dict(self.environment),
        )

    @overload
    def text(self, element: Element, name: str) -> str: ...
    @overload
    def text(self, element: Element, name: str, default: str) -> str: ...
    @overload
    def text(self, element: Element, name: str, default: None) -> str | None: ...
    def text(self, element: Element, name: str, default: str | None = '') -> str | None:
        """Return an attribute with its substitutions made, or `default` where it is absent.

        Raises:
            CommandError: If a substitution in it has no value; the message says where it stands.
        """
        if name not in element.attributes:
            return default
        template = template_of(element, name)
        try:
            return evaluate(template, self.configurations, element.file)
        except SubstitutionError as error:
            raise CommandError(f'{element.where}: {error}') from error

    def wants(self, element: Element) -> bool:
        """Say whether the element's `if` or `unless` lets it act."""
        return self._flag(element, 'if', True) and not self._flag(element, 'unless', False)

    def _flag(self, element: Element, name: str, default: bool) -> bool:
        try:
            return as_bool(self.text(element, name, str(default)))
        except SubstitutionError as error:
            raise CommandError(f'{element.where} {name}: {error}') from error

    def prefixed(self, namespace: str | None) -> str | None:
        """Return the absolute namespace that `namespace` means here; None for neither."""
        if namespace is None:
            return self.namespace
        if not namespace.startswith('/'):
            namespace = f'{(self.namespace or "").rstrip("/")}/{namespace}'
        return namespace.rstrip('/') or '/'


def template_of(element: Element, name: str) -> Template:
    """Return an attribute, split into text and substitutions.

    Raises:
        CommandError: If a substitution in it is malformed.
    """
    try:
        return parse(element.attributes[name])
    except SubstitutionError as error:
        raise CommandError(f'{element.where} {name}: {error}') from error
