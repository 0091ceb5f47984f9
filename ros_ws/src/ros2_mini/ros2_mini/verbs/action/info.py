# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""`ros2 action info`: the clients and servers of an action."""

import argparse
from collections.abc import Callable

from rclpy.action import (
    get_action_client_names_and_types_by_node,
    get_action_server_names_and_types_by_node,
)
from rclpy.node import Node

from ros2_mini import listing
from ros2_mini.names import full_name
from ros2_mini.node_context import graph_node
from ros2_mini.topics import expanded


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of `ros2 action info`."""
    parser.add_argument('action_name', help="Name of the ROS action (e.g. '/fibonacci')")
    listing.add_types_argument(parser, 'action')
    parser.add_argument(
        '-c', '--count', action='store_true',
        help='Only display the number of action clients and action servers',
    )  # fmt: skip


def main(args: argparse.Namespace) -> int:
    """Print the nodes that use or serve the action."""
    with graph_node() as node:
        action = expanded(node, args.action_name)
        roles = {
            'clients': _nodes(node, action, get_action_client_names_and_types_by_node),
            'servers': _nodes(node, action, get_action_server_names_and_types_by_node),
        }
    print(f'Action: {args.action_name}')
    for role, nodes in roles.items():
        print(f'Action {role}: {len(nodes)}')
        if not args.count:
            listing.print_lines(nodes, args, indent='    ')
    return 0


def _nodes(
    node: Node, action: str, look: Callable[[Node, str, str], list[tuple[str, list[str]]]]
) -> list[tuple[str, list[str]]]:
    """Return the nodes that `look` finds to have the action, with the types they give it."""
    return [
        (full_name(name, namespace), types)
        for name, namespace in node.get_node_names_and_namespaces()
        for found, types in look(node, name, namespace)
        if found == action
    ]
