# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""`ros2 param set`: set a parameter."""

import argparse
import sys

from rclpy.parameter import get_parameter_value

from ros2_mini import calls
from ros2_mini.calls import find_node
from ros2_mini.node_context import open_node
from ros2_mini.parameters import set_parameter


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of `ros2 param set`."""
    calls.add_arguments(parser)
    parser.add_argument('node_name', help='Name of the ROS node')
    parser.add_argument('parameter_name', help='Name of the parameter')
    parser.add_argument('value', help='Value of the parameter')


def main(args: argparse.Namespace) -> int:
    """Set the parameter and print the node's answer; a refusal still exits with 0, as upstream."""
    with open_node() as node:
        target = find_node(node, args.node_name, args)
        value = get_parameter_value(string_value=args.value)
        result = set_parameter(node, target, args.parameter_name, value)
    reason = f': {result.reason}' if result.reason else ''
    if result.successful:
        print(f'Set parameter successful{reason}')
    else:
        print(f'Setting parameter failed{reason}', file=sys.stderr)
    return 0
