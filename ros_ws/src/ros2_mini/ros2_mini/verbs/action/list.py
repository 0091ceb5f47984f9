# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""`ros2 action list`: the actions in the graph."""

import argparse

from rclpy.action import get_action_names_and_types

from ros2_mini import discovery
from ros2_mini.node_context import graph_node


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of `ros2 action list`."""
    discovery.add_arguments(parser)
    parser.add_argument(
        '-t', '--show-types', action='store_true', help='Additionally show the action type'
    )
    parser.add_argument(
        '-c', '--count-actions', action='store_true',
        help='Only display the number of actions discovered',
    )  # fmt: skip


def main(args: argparse.Namespace) -> int:
    """Print one action a line."""
    with graph_node(args.spin_time) as node:
        actions = sorted(get_action_names_and_types(node))
    if args.count_actions:
        print(len(actions))
        return 0
    for name, types in actions:
        print(f'{name} [{", ".join(types)}]' if args.show_types else name)
    return 0
