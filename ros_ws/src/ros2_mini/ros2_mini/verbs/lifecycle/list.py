# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""`ros2 lifecycle list`: the transitions that a node can make."""

import argparse

from ros2_mini import calls
from ros2_mini.calls import find_node
from ros2_mini.lifecycles import get_transitions
from ros2_mini.node_context import open_node


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of `ros2 lifecycle list`."""
    calls.add_arguments(parser)
    parser.add_argument('node_name', help='Name of the ROS node')
    parser.add_argument(
        '-a', '--all', action='store_true', help='Display all existing transitions'
    )


def main(args: argparse.Namespace) -> int:
    """Print each transition with the states it leads from and to."""
    with open_node() as node:
        target = find_node(node, args.node_name, args)
        for found in get_transitions(node, target, everything=args.all):
            print(
                f'- {found.transition.label} [{found.transition.id}]\n'
                f'\tStart: {found.start_state.label}\n'
                f'\tGoal: {found.goal_state.label}'
            )
    return 0
