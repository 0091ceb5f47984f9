# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Read and set the parameters of other nodes."""

from collections.abc import Sequence
from typing import Any

from rcl_interfaces.msg import (
    Parameter,
    ParameterDescriptor,
    ParameterType,
    ParameterValue,
    SetParametersResult,
)
from rcl_interfaces.srv import DescribeParameters, GetParameters, ListParameters, SetParameters
from rclpy.node import Node
from rclpy.parameter import parameter_value_to_python

from ros2_mini.calls import call

# Name of each type, and how `ros2 param get` introduces a value of it.
TYPE_NAMES: dict[int, str] = {
    ParameterType.PARAMETER_NOT_SET: 'not set',
    ParameterType.PARAMETER_BOOL: 'boolean',
    ParameterType.PARAMETER_INTEGER: 'integer',
    ParameterType.PARAMETER_DOUBLE: 'double',
    ParameterType.PARAMETER_STRING: 'string',
    ParameterType.PARAMETER_BYTE_ARRAY: 'byte array',
    ParameterType.PARAMETER_BOOL_ARRAY: 'boolean array',
    ParameterType.PARAMETER_INTEGER_ARRAY: 'integer array',
    ParameterType.PARAMETER_DOUBLE_ARRAY: 'double array',
    ParameterType.PARAMETER_STRING_ARRAY: 'string array',
}


def list_parameters(node: Node, target: str, prefixes: Sequence[str] = ()) -> list[str]:
    """Return the names of a node's parameters, sorted."""
    request = ListParameters.Request(prefixes=list(prefixes))
    response = call(node, ListParameters, f'{target}/list_parameters', request)
    return sorted(response.result.names)


def get_parameters(node: Node, target: str, names: Sequence[str]) -> list[ParameterValue]:
    """Return the values of parameters; a node may answer with fewer than it was asked for."""
    request = GetParameters.Request(names=list(names))
    return call(node, GetParameters, f'{target}/get_parameters', request).values


def describe_parameters(
    node: Node, target: str, names: Sequence[str]
) -> list[ParameterDescriptor]:
    """Return the descriptors of parameters."""
    request = DescribeParameters.Request(names=list(names))
    return call(node, DescribeParameters, f'{target}/describe_parameters', request).descriptors


def set_parameter(
    node: Node, target: str, name: str, value: ParameterValue
) -> SetParametersResult:
    """Set a parameter and return what the node says to that."""
    request = SetParameters.Request(parameters=[Parameter(name=name, value=value)])
    return call(node, SetParameters, f'{target}/set_parameters', request).results[0]


def python_value(value: ParameterValue) -> Any:
    """Return a value in plain Python types; None if it is not set."""
    found = parameter_value_to_python(value)
    return found.tolist() if hasattr(found, 'tolist') else found
