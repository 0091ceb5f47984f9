# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""`ros2 param get`: the value of a parameter."""

import argparse

from rcl_interfaces.msg import ParameterType

from ros2_mini import calls
from ros2_mini.calls import find_node
from ros2_mini.errors import CommandError
from ros2_mini.node_context import open_node
from ros2_mini.parameters import TYPE_NAMES, get_parameters, python_value


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of `ros2 param get`."""
    calls.add_arguments(parser)
    parser.add_argument('node_name', help='Name of the ROS node')
    parser.add_argument('parameter_name', help='Name of the parameter')
    parser.add_argument('--hide-type', action='store_true', help='Hide the type information')


def main(args: argparse.Namespace) -> int:
    """Print the value."""
    with open_node() as node:
        target = find_node(node, args.node_name, args)
        values = get_parameters(node, target, [args.parameter_name])
    if not values:
        raise CommandError(f"Parameter not set: '{args.parameter_name}' of '{target}'")
    if args.hide_type:
        print(python_value(values[0]))
    elif values[0].type == ParameterType.PARAMETER_NOT_SET:
        print('Parameter not set.')
    else:
        print(_label(values[0].type), python_value(values[0]))
    return 0


def _label(kind: int) -> str:
    """Return the introduction of a value: `Double value is:`, `Double values are:`."""
    name, _, array = TYPE_NAMES[kind].capitalize().partition(' ')
    return f'{name} values are:' if array else f'{name} value is:'
