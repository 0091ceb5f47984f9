# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Parameters of a node in a launch file: their types, and the files that carry them to it."""

import tempfile
from pathlib import Path
from typing import TypeAlias

import yaml

from ros2_mini.errors import CommandError
from ros2_mini.launch.document import Element
from ros2_mini.launch.scope import Scope

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
