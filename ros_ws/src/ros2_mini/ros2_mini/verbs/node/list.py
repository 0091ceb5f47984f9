# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""`ros2 node list`: the nodes in the graph."""

import argparse
import sys

from ros2_mini import discovery, listing
from ros2_mini.names import node_names
from ros2_mini.node_context import graph_node


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of `ros2 node list`."""
    discovery.add_arguments(parser)
    parser.add_argument(
        '-a', '--all', action='store_true', help='Display all nodes even hidden ones'
    )
    listing.add_count_argument(parser, 'node')


def main(args: argparse.Namespace) -> int:
    """Print one node name a line."""
    with graph_node(args.spin_time) as node:
        names = node_names(node, hidden=args.all)
    if args.count:
        print(len(names))
        return 0
    if len(set(names)) < len(names):
        print(
            'WARNING: Be aware that there are nodes in the graph that share an exact name, '
            'which can have unintended side effects.',
            file=sys.stderr,
        )
    for name in names:
        print(name)
    return 0
