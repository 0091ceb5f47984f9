# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""`ros2 lifecycle get`: the state of one lifecycle node or of all."""

import argparse

from ros2_mini import calls
from ros2_mini.calls import find_node
from ros2_mini.lifecycles import get_state, lifecycle_nodes
from ros2_mini.node_context import graph_node, open_node


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of `ros2 lifecycle get`."""
    calls.add_arguments(parser)
    parser.add_argument('node_name', nargs='?', help='Name of the ROS node; all when left out')


def main(args: argparse.Namespace) -> int:
    """Print label and number of the state."""
    if args.node_name is not None:
        with open_node() as node:
            state = get_state(node, find_node(node, args.node_name, args))
        print(f'{state.label} [{state.id}]')
        return 0
    with graph_node(args.spin_time) as node:
        targets = lifecycle_nodes(node, hidden=args.include_hidden_nodes)
    with open_node() as node:
        for target in targets:
            state = get_state(node, target)
            print(f'{target}: {state.label} [{state.id}]')
    return 0
