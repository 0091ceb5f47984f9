# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Expand a launch file, and all that it includes, into a plan of processes."""

from collections.abc import Callable, Mapping
from pathlib import Path

from ros2_mini.errors import CommandError
from ros2_mini.launch.document import Element, read_launch_file
from ros2_mini.launch.node_command import executable_process, node_process, prefixed
from ros2_mini.launch.plan import Plan
from ros2_mini.launch.scope import Scope


def expand_launch_file(
    path: Path,
    arguments: Mapping[str, str],
    environment: Mapping[str, str],
    parameter_directory: Path,
) -> Plan:
    """Return what a launch file comes to.

    Args:
        path: The launch file.
        arguments: Launch arguments by name.
        environment: Environment that the processes start from.
        parameter_directory: Where to write the parameters given in the file.

    Raises:
        CommandError: If the file, or one that it includes, cannot be expanded; no process has
            been started then.
    """
    scope = Scope(dict(arguments), dict(environment), parameter_directory)
    plan = Plan()
    _expand_file(path, scope, plan)
    return plan


def _expand_file(path: Path, scope: Scope, plan: Plan) -> None:
    path = path.absolute()
    if path in scope.files:
        raise CommandError(f"launch file '{path}' includes itself")
    scope.files += (path,)
    _expand_all(read_launch_file(path).children, scope, plan)
    scope.files = scope.files[:-1]


def _expand_all(elements: list[Element], scope: Scope, plan: Plan) -> None:
    for element in elements:
        if scope.wants(element):
            _ACTIONS[element.tag](element, scope, plan)


def _arg(element: Element, scope: Scope, plan: Plan) -> None:
    """Give the argument its default if nobody has set it; an included file sees its includer's."""
    name = element.attributes['name']
    plan.arguments.add(name)
    if name not in scope.configurations:
        default = scope.text(element, 'default', None)
        if default is None:
            description = element.attributes.get('description', 'no description given')
            raise CommandError(
                f"{element.where}: required launch argument '{name}' ({description}) was not "
                f"provided, expected '{name}:=<value>'"
            )
        scope.configurations[name] = default
    choices = [choice.attributes['value'] for choice in element.nested('choice')]
    if choices and scope.configurations[name] not in choices:
        raise CommandError(
            f"{element.where}: argument '{name}' has the value '{scope.configurations[name]}', "
            f'expected one of {choices}'
        )


def _let(element: Element, scope: Scope, plan: Plan) -> None:
    scope.configurations[scope.text(element, 'name')] = scope.text(element, 'value')


def _set_env(element: Element, scope: Scope, plan: Plan) -> None:
    scope.environment[scope.text(element, 'name')] = scope.text(element, 'value')


def _unset_env(element: Element, scope: Scope, plan: Plan) -> None:
    scope.environment.pop(scope.text(element, 'name'), None)


def _group(element: Element, scope: Scope, plan: Plan) -> None:
    inner = scope.copy() if scope.flag(element, 'scoped', True) else scope
    _expand_all(element.children, inner, plan)


def _push_ros_namespace(element: Element, scope: Scope, plan: Plan) -> None:
    scope.namespace = prefixed(scope.namespace, scope.text(element, 'namespace'))


def _include(element: Element, scope: Scope, plan: Plan) -> None:
    """Expand a file in this very scope: what it sets stays set, as in the launch library."""
    path = Path(scope.text(element, 'file'))
    if not path.is_file():
        raise CommandError(f"{element.where}: launch file '{path}' does not exist")
    for arg in element.nested('arg'):
        scope.configurations[scope.text(arg, 'name')] = scope.text(arg, 'value')
    _expand_file(path, scope, plan)


def _node(element: Element, scope: Scope, plan: Plan) -> None:
    plan.processes.append(node_process(scope, element, len(plan.processes) + 1))


def _executable(element: Element, scope: Scope, plan: Plan) -> None:
    plan.processes.append(executable_process(scope, element, len(plan.processes) + 1))


def _log(element: Element, scope: Scope, plan: Plan) -> None:
    plan.messages.append(scope.text(element, 'message'))


def _shutdown(element: Element, scope: Scope, plan: Plan) -> None:
    plan.shutdown = scope.text(element, 'reason', 'reason not given')


_ACTIONS: dict[str, Callable[[Element, Scope, Plan], None]] = {
    'arg': _arg,
    'executable': _executable,
    'group': _group,
    'include': _include,
    'let': _let,
    'log': _log,
    'node': _node,
    'push_ros_namespace': _push_ros_namespace,
    'push-ros-namespace': _push_ros_namespace,
    'set_env': _set_env,
    'shutdown': _shutdown,
    'unset_env': _unset_env,
}
