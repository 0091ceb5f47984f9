# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Expand a launch file, and all that it includes, into a plan of processes."""

from collections.abc import Callable, Mapping
from pathlib import Path

from ros2_mini.errors import CommandError
from ros2_mini.launch.document import Element, read_launch_file
from ros2_mini.launch.parameters import parameter_arguments
from ros2_mini.launch.scope import Scope
from ros2_mini.launch.supervisor import OUTPUTS, Plan, ProcessSpec
from ros2_mini.packages import executable_path


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


def _set_env(element: Element, scope: Scope, plan: Plan) -> None:
    scope.environment[scope.text(element, 'name')] = scope.text(element, 'value')


def _group(element: Element, scope: Scope, plan: Plan) -> None:
    _expand_all(element.children, scope.copy(), plan)


def _push_ros_namespace(element: Element, scope: Scope, plan: Plan) -> None:
    scope.namespace = scope.prefixed(scope.text(element, 'namespace'))


def _include(element: Element, scope: Scope, plan: Plan) -> None:
    """Expand a file in this very scope: what it sets stays set, as in the launch library."""
    path = Path(scope.text(element, 'file'))
    if not path.is_file():
        raise CommandError(f"{element.where}: launch file '{path}' does not exist")
    for arg in element.nested('arg'):
        scope.configurations[scope.text(arg, 'name')] = scope.text(arg, 'value')
    _expand_file(path, scope, plan)


def _node(element: Element, scope: Scope, plan: Plan) -> None:
    try:
        path = executable_path(scope.text(element, 'pkg'), scope.text(element, 'exec'))
    except CommandError as error:
        raise CommandError(f'{element.where}: {error}') from error
    command = [str(path), '--ros-args', *_names(scope, element)]
    for remap in element.nested('remap'):
        command += ['-r', f'{scope.text(remap, "from")}:={scope.text(remap, "to")}']
    output = scope.text(element, 'output', 'log')
    on_exit = scope.text(element, 'on_exit', None)
    if output not in OUTPUTS:
        raise CommandError(
            f"{element.where} has output '{output}'; supported: {', '.join(OUTPUTS)}"
        )
    if on_exit not in (None, 'shutdown'):
        raise CommandError(f"{element.where} has on_exit '{on_exit}'; supported: shutdown")
    plan.processes.append(
        ProcessSpec(
            name=f'{path.name}-{len(plan.processes) + 1}',
            command=tuple(command),
            environment=dict(scope.environment),
            output=output,
            shutdown_on_exit=on_exit == 'shutdown',
        )
    )


def _names(scope: Scope, node: Element) -> list[str]:
    """Return the arguments that set a node's name, namespace and parameters."""
    name = scope.text(node, 'name', None)
    namespace = scope.prefixed(scope.text(node, 'namespace', None))
    arguments = []
    if name is not None:
        arguments += ['-r', f'__node:={name}']
    if namespace is not None:
        arguments += ['-r', f'__ns:={namespace}']
    known = name is not None and namespace is not None
    full_name = f'{(namespace or "").rstrip("/")}/{name}' if known else '/**'
    return arguments + parameter_arguments(scope, node, full_name)


_ACTIONS: dict[str, Callable[[Element, Scope, Plan], None]] = {
    'arg': _arg,
    'group': _group,
    'include': _include,
    'node': _node,
    'push_ros_namespace': _push_ros_namespace,
    'push-ros-namespace': _push_ros_namespace,
    'set_env': _set_env,
}
