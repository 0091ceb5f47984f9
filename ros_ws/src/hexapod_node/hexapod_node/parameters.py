# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Declares a node's parameters from one table, which docs/interfaces.md is made of as well."""

import ast
import inspect
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, fields
from functools import partial
from itertools import pairwise
from typing import Any, Generic, Literal, TypeVar, get_args, get_origin, get_type_hints
from weakref import WeakSet

from rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
    SetParametersResult,
)
from rcl_interfaces.msg import Parameter as ParameterMessage
from rclpy.node import Node
from rclpy.parameter import Parameter as RclpyParameter

Scalar = bool | int | float | str
Value = Scalar | list[str]
Config = TypeVar('Config')
# Nodes that take whole numbers for real ones.
_widening: WeakSet[Node] = WeakSet()


@dataclass(frozen=True)
class Parameter:
    """One parameter of a node: what it is, in which unit, and what it may be."""

    name: str
    default: Value
    description: str
    unit: str = ''
    range: tuple[float, float] | None = None
    """Least and greatest value allowed."""
    choices: tuple[str, ...] = ()
    """The values allowed, for text."""
    read_only: bool = True
    """Set at start only; otherwise `ros2 param set` works while the node runs."""


def declare(node: Node, table: Iterable[Parameter]) -> None:
    """Declare each parameter of the table with its description, unit and limits.

    A whole number may be given for a real one, at start and later: `rate:=2` is `rate:=2.0`. At
    start one text may be given for a list of texts.

    Raises:
        rclpy.exceptions.InvalidParameterTypeException: a value given at start is of another type.
        rclpy.exceptions.InvalidParameterValueException: a value given at start is not allowed.
    """
    table = tuple(table)
    choices = {parameter.name: parameter.choices for parameter in table if parameter.choices}
    if choices:
        node.add_on_set_parameters_callback(lambda values: _check_choices(values, choices))
    if node not in _widening:
        # One per node: rclpy strings together what several such callbacks return.
        node.add_pre_set_parameters_callback(partial(_widened, node))
        _widening.add(node)
    for parameter in table:
        value = _widened_at_start(node, parameter)
        node.declare_parameter(
            parameter.name,
            parameter.default if value is None else value,
            descriptor(parameter),
            ignore_override=value is not None,
        )


def _widened_at_start(node: Node, parameter: Parameter) -> float | list[str] | None:
    """Return the real number, or the list, that a value given at start stands for, if it does.

    rclpy holds a declared type against what the command line said. A declaration without a type
    tells what that was.
    """
    if not isinstance(parameter.default, float | list):
        return None
    probe = ParameterDescriptor(dynamic_typing=True)
    given = node.declare_parameter(parameter.name, parameter.default, probe)
    node.undeclare_parameter(parameter.name)
    if isinstance(parameter.default, list):
        return [given.value] if given.type_ == RclpyParameter.Type.STRING else None
    return float(given.value) if given.type_ == RclpyParameter.Type.INTEGER else None


def _widened(node: Node, parameters: list[RclpyParameter]) -> list[RclpyParameter]:
    """Return the parameters, whole numbers for the node's real ones made real."""
    return [
        RclpyParameter(parameter.name, value=float(parameter.value))
        if parameter.type_ == RclpyParameter.Type.INTEGER
        and node.has_parameter(parameter.name)
        and node.get_parameter(parameter.name).type_ == RclpyParameter.Type.DOUBLE
        else parameter
        for parameter in parameters
    ]


def descriptor(parameter: Parameter) -> ParameterDescriptor:
    """Return what `ros2 param describe` prints."""
    constraints = [f'unit: {parameter.unit}'] if parameter.unit else []
    if parameter.choices:
        constraints.append(f'one of: {", ".join(parameter.choices)}')
    message = ParameterDescriptor(
        description=parameter.description,
        additional_constraints='; '.join(constraints),
        read_only=parameter.read_only,
    )
    if parameter.range is not None:
        low, high = parameter.range
        if isinstance(parameter.default, float):
            message.floating_point_range = [
                FloatingPointRange(from_value=float(low), to_value=float(high), step=0.0)
            ]
        else:
            message.integer_range = [IntegerRange(from_value=int(low), to_value=int(high), step=1)]
    return message


class ConfigParameters(Generic[Config]):
    """A configuration dataclass as settable parameters `prefix.field` of a node.

    Values that the dataclass refuses with a ValueError are refused with that text.
    """

    def __init__(self, node: Node, default: Config, prefix: str) -> None:
        """Declare the parameters.

        Args:
            node: whose they are.
            default: what they are where nothing else is said.
            prefix: of their names.
        """
        self._node = node
        self._config = type(default)
        self._prefix = prefix
        declare(node, config_table(default, prefix))
        node.add_on_set_parameters_callback(self._check)

    def get(self) -> Config:
        """Return the configuration that the parameters say now."""
        return self._config(**self._values())

    def _values(self) -> dict[str, Any]:
        names = self._node.get_parameters_by_prefix(self._prefix)
        return {name: self._node.get_parameter(f'{self._prefix}.{name}').value for name in names}

    def _check(self, parameters: list[RclpyParameter]) -> SetParametersResult:
        start = f'{self._prefix}.'
        changed = {p.name[len(start) :]: p.value for p in parameters if p.name.startswith(start)}
        try:
            self._config(**(self._values() | changed))
        except ValueError as error:
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)


def config_table(default: Any, prefix: str) -> tuple[Parameter, ...]:
    """Return the parameters that the scalar fields of a configuration make, with its values.

    A field's docstring is the description; where it ends in brackets, they hold the unit. An
    `Interval` in its annotation is the range, a `Literal` the choices.
    """
    config = type(default)
    docs = field_docs(config)
    hints = get_type_hints(config, include_extras=True)
    table = []
    for field in fields(config):
        value = getattr(default, field.name)
        if isinstance(value, Scalar):
            text, unit = _split_unit(docs.get(field.name, ''))
            name = f'{prefix}.{field.name}'
            hint = hints[field.name]
            choices = get_args(hint) if get_origin(hint) is Literal else ()
            limits = _limits(hint)
            table.append(Parameter(name, value, text, unit, limits, choices, read_only=False))
    return tuple(table)


def _limits(hint: Any) -> tuple[float, float] | None:
    """Return least and greatest value of an annotation; None if it has no interval.

    The interval is any object with `ge` and `le`, as annotated_types and pydantic know it.
    """
    for mark in getattr(hint, '__metadata__', ()):
        if hasattr(mark, 'ge') and hasattr(mark, 'le'):
            return mark.ge, mark.le
    return None


def field_docs(config: type) -> dict[str, str]:
    """Return the string that follows each field in the source of a dataclass and its bases."""
    docs: dict[str, str] = {}
    for base in config.__mro__[:-1]:
        docs = _own_field_docs(base) | docs
    return docs


def _own_field_docs(config: type) -> dict[str, str]:
    (definition,) = ast.parse(inspect.cleandoc(inspect.getsource(config))).body
    assert isinstance(definition, ast.ClassDef)
    docs = {}
    for statement, following in pairwise(definition.body):
        if isinstance(statement, ast.AnnAssign) and isinstance(following, ast.Expr):
            value = following.value
            if isinstance(value, ast.Constant) and isinstance(statement.target, ast.Name):
                docs[statement.target.id] = ' '.join(str(value.value).split())
    return docs


def _split_unit(doc: str) -> tuple[str, str]:
    found = re.search(r'\[([^\]]+)\]', doc)
    if found is None:
        return doc.rstrip('.'), ''
    return (doc[: found.start()].rstrip() + doc[found.end() :]).rstrip('.'), found.group(1)


def _check_choices(
    parameters: list[RclpyParameter], choices: dict[str, tuple[str, ...]]
) -> SetParametersResult:
    for parameter in parameters:
        allowed = choices.get(parameter.name)
        if allowed is not None and parameter.value not in allowed:
            reason = f"{parameter.name} '{parameter.value}': expected one of {', '.join(allowed)}"
            return SetParametersResult(successful=False, reason=reason)
    return SetParametersResult(successful=True)


def to_messages(prefix: str, config: Mapping[str, Any]) -> list[ParameterMessage]:
    """Return values as parameters `prefix.name`, for the service that sets them."""
    return [
        RclpyParameter(f'{prefix}.{name}', value=value).to_parameter_msg()
        for name, value in config.items()
    ]
