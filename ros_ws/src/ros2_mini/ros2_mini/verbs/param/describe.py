# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""`ros2 param describe`: type, meaning and limits of parameters."""

import argparse

from rcl_interfaces.msg import ParameterDescriptor

from ros2_mini import calls
from ros2_mini.calls import find_node
from ros2_mini.node_context import open_node
from ros2_mini.parameters import TYPE_NAMES, describe_parameters


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of `ros2 param describe`."""
    calls.add_arguments(parser)
    parser.add_argument('node_name', help='Name of the ROS node')
    parser.add_argument('parameter_names', nargs='+', help='Names of the parameters')


def main(args: argparse.Namespace) -> int:
    """Print what the node says of each parameter."""
    with open_node() as node:
        target = find_node(node, args.node_name, args)
        for descriptor in describe_parameters(node, target, args.parameter_names):
            print('\n'.join(_lines(descriptor)))
    return 0


def _lines(descriptor: ParameterDescriptor) -> list[str]:
    lines = [f'Parameter name: {descriptor.name}', f'  Type: {TYPE_NAMES[descriptor.type]}']
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
