# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""`ros2 action list`: the actions in the graph."""

import argparse

from rclpy.action import get_action_names_and_types

from ros2_mini import listing
from ros2_mini.node_context import graph_node


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of `ros2 action list`."""
    listing.add_types_argument(parser, 'action')
    listing.add_count_argument(parser, 'action')


def main(args: argparse.Namespace) -> int:
    """Print one action a line."""
    with graph_node() as node:
        actions = sorted(get_action_names_and_types(node))
    listing.print_names(actions, args)
    return 0
