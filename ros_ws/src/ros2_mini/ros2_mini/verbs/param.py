# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""`ros2 param`: parameters of other nodes."""

import argparse
import sys

from rcl_interfaces.msg import Parameter, ParameterDescriptor, ParameterType
from rcl_interfaces.srv import DescribeParameters, GetParameters, SetParameters
from rclpy.parameter import get_parameter_value, parameter_value_to_python

from ros2_mini import node_calls
from ros2_mini.errors import CommandError
from ros2_mini.node_calls import asking

# Name of each type, and how `get` introduces a value of it.
_TYPE_NAMES: dict[int, str] = {
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


def _describe_arguments(parser: argparse.ArgumentParser) -> None:
    node_calls.add_arguments(parser)
    parser.add_argument('node_name', help='Name of the ROS node')
    parser.add_argument('parameter_names', nargs='+', help='Names of the parameters')


def _describe(args: argparse.Namespace) -> int:
    """Print type, meaning and limits of each parameter."""
    request = DescribeParameters.Request(names=args.parameter_names)
    with asking(args) as (_, ask):
        response = ask(DescribeParameters, 'describe_parameters', request)
    for descriptor in response.descriptors:
        print('\n'.join(_description(descriptor)))
    return 0


def _description(descriptor: ParameterDescriptor) -> list[str]:
    lines = [f'Parameter name: {descriptor.name}', f'  Type: {_TYPE_NAMES[descriptor.type]}']
    if descriptor.description:
        lines.append(f'  Description: {descriptor.description}')
    lines.append('  Constraints:')
    if descriptor.read_only:
        lines.append('    Read only: true')
    for limits in [*descriptor.floating_point_range, *descriptor.integer_range]:
        lines += [f'    Min value: {limits.from_value}', f'    Max value: {limits.to_value}']
        if limits.step:
            lines.append(f'    Step: {limits.step}')
    if descriptor.additional_constraints:
        lines.append(f'    Additional constraints: {descriptor.additional_constraints}')
    return lines


def _get_arguments(parser: argparse.ArgumentParser) -> None:
    node_calls.add_arguments(parser)
    parser.add_argument('node_name', help='Name of the ROS node')
    parser.add_argument('parameter_name', help='Name of the parameter')
    parser.add_argument('--hide-type', action='store_true', help='Hide the type information')


def _get(args: argparse.Namespace) -> int:
    """Print the value."""
    request = GetParameters.Request(names=[args.parameter_name])
    with asking(args) as (target, ask):
        values = ask(GetParameters, 'get_parameters', request).values
    if not values:
        raise CommandError(f"Parameter not set: '{args.parameter_name}' of '{target}'")
    value = parameter_value_to_python(values[0])
    value = value.tolist() if hasattr(value, 'tolist') else value
    if args.hide_type:
        print(value)
    elif values[0].type == ParameterType.PARAMETER_NOT_SET:
        print('Parameter not set.')
    else:
        print(_label(values[0].type), value)
    return 0


def _label(kind: int) -> str:
    """Return the introduction of a value: `Double value is:`, `Double values are:`."""
    name, _, array = _TYPE_NAMES[kind].capitalize().partition(' ')
    return f'{name} values are:' if array else f'{name} value is:'


def _set_arguments(parser: argparse.ArgumentParser) -> None:
    node_calls.add_arguments(parser)
    parser.add_argument('node_name', help='Name of the ROS node')
    parser.add_argument('parameter_name', help='Name of the parameter')
    parser.add_argument('value', help='Value of the parameter')


def _set(args: argparse.Namespace) -> int:
    """Set the parameter and print the node's answer; a refusal still exits with 0, as upstream."""
    value = get_parameter_value(string_value=args.value)
    request = SetParameters.Request(parameters=[Parameter(name=args.parameter_name, value=value)])
    with asking(args) as (_, ask):
        (result,) = ask(SetParameters, 'set_parameters', request).results
    reason = f': {result.reason}' if result.reason else ''
    if result.successful:
        print(f'Set parameter successful{reason}')
    else:
        print(f'Setting parameter failed{reason}', file=sys.stderr)
    return 0


VERBS = {
    'describe': (_describe_arguments, _describe),
    'get': (_get_arguments, _get),
    'set': (_set_arguments, _set),
}
