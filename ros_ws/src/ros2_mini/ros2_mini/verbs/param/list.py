# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""`ros2 param list`: the parameters of one node or of all."""

import argparse
import re
import sys

from rclpy.node import Node

from ros2_mini import calls
from ros2_mini.calls import find_node
from ros2_mini.errors import CommandError
from ros2_mini.names import node_names
from ros2_mini.node_context import graph_node, open_node
from ros2_mini.parameters import TYPE_NAMES, describe_parameters, list_parameters


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of `ros2 param list`."""
    calls.add_arguments(parser)
    parser.add_argument('node_name', nargs='?', help='Name of the ROS node')
    parser.add_argument('--filter', metavar='REGEX', help='Only parameters that match')
    parser.add_argument(
        '--param-prefixes', nargs='+', default=[],
        help='Only list parameters with the provided prefixes',
    )  # fmt: skip
    parser.add_argument(
        '--param-type', action='store_true', help='Print parameter types with parameter names'
    )


def main(args: argparse.Namespace) -> int:
    """Print one parameter a line, below the name of its node where all nodes are listed."""
    if args.node_name is None:
        with graph_node(args.spin_time) as node:
            targets = node_names(node, hidden=args.include_hidden_nodes)
        with open_node() as node:
            for target in targets:
                _print_node(node, target, args)
        return 0
    with open_node() as node:
        for line in _lines(node, find_node(node, args.node_name, args), args):
            print(line)
    return 0


def _print_node(node: Node, target: str, args: argparse.Namespace) -> None:
    try:
        lines = _lines(node, target, args)
    except CommandError as error:
        print(error, file=sys.stderr)  # a node without parameter services: go on to the next
        return
    if lines:
        print('\n'.join([f'{target}:', *lines]))


def _lines(node: Node, target: str, args: argparse.Namespace) -> list[str]:
    names = list_parameters(node, target, args.param_prefixes)
    if args.filter is not None:
        names = [name for name in names if re.match(args.filter, name)]
    if not args.param_type:
        return [f'  {name}' for name in names]
    descriptors = describe_parameters(node, target, names)
    return [f'  {found.name} (type: {TYPE_NAMES[found.type]})' for found in descriptors]
