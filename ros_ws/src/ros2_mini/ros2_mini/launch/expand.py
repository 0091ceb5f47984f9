# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Expand a launch file, and all that it includes, into a plan of processes."""

import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TypeAlias

import yaml

from ros2_mini.errors import CommandError
from ros2_mini.launch.document import Element, read_launch_file
from ros2_mini.launch.scope import Scope
from ros2_mini.launch.supervisor import OUTPUTS, Plan, ProcessSpec
from ros2_mini.packages import executable_path

Scalar: TypeAlias = bool | int | float | str
ParameterValue: TypeAlias = Scalar | list[Scalar]

TYPES = ('yaml', 'str')


def parameter_arguments(scope: Scope, node: Element, node_name: str) -> list[str]:
    """Return the command line arguments that give a node its `<param>` elements, in order.

    Args:
        scope: Where the node stands.
        node: The `<node>` element.
        node_name: Fully qualified name of the node, or `/**` when it is not known.
    """
    arguments = []
    for param in node.nested('param'):
        arguments += ['--params-file', str(_parameter_file(scope, param, node_name))]
    return arguments


def _parameter_file(scope: Scope, param: Element, node_name: str) -> Path:
    source = scope.text(param, 'from', None)
    if source is None:
        return _write(scope, param, node_name)
    if {'name', 'value', 'type'} & param.attributes.keys():
        raise CommandError(f"{param.where} has 'from', expected no name, value or type with it")
    if not Path(source).is_file():
        raise CommandError(f"{param.where}: parameter file '{source}' does not exist")
    return Path(source).absolute()


def _write(scope: Scope, param: Element, node_name: str) -> Path:
    """Write one name and value as a parameter file, which is how the launch library does it."""
    if not {'name', 'value'} <= param.attributes.keys():
        raise CommandError(f"{param.where} needs 'name' and 'value', or 'from'")
    text = scope.text(param, 'value')
    try:
        value = parameter_value(text, scope.text(param, 'type', 'yaml'))
    except ValueError as error:
        raise CommandError(f'{param.where}: {error}') from error
    content = {node_name: {'ros__parameters': {scope.text(param, 'name'): value}}}
    with tempfile.NamedTemporaryFile(
        'w', prefix='launch_params_', dir=scope.parameter_directory, delete=False
    ) as file:
        yaml.safe_dump(content, file)
    return Path(file.name)


def parameter_value(text: str, type_name: str = 'yaml') -> ParameterValue:
    """Return the value that a text stands for.

    Args:
        text: The value as written, substitutions made.
        type_name: One of TYPES; `yaml` lets the text decide, by the rules of YAML 1.1.

    Raises:
        ValueError: If the text is no value of that type, or of a type that parameters lack.
    """
    if type_name not in TYPES:
        raise ValueError(f"parameter type '{type_name}' is unknown, expected {', '.join(TYPES)}")
    if type_name == 'str' or not text:
        return text
    try:
        value = yaml.safe_load(text)
    except yaml.YAMLError as error:
        raise ValueError(f'value \'{text}\' is no YAML; give a text with type="str"') from error
    if isinstance(value, list):
        kinds = {type(item) for item in value}
        if len(kinds) != 1 or not isinstance(value[0], bool | int | float | str):
            raise ValueError(f"value '{text}' is no list of one type of bool, int, float or str")
        return value
    if not isinstance(value, bool | int | float | str):
        raise ValueError(f"value '{text}' is no bool, int, float, str or list of these")
    return value


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
