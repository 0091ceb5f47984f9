# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""`ros2 node info`: topics, services and actions of a node."""

import argparse
import sys
from collections.abc import Callable, Sequence
from functools import partial
from typing import TypeAlias

from rclpy.action import (
    get_action_client_names_and_types_by_node,
    get_action_server_names_and_types_by_node,
)
from rclpy.node import Node

from ros2_mini import discovery
from ros2_mini.errors import CommandError
from ros2_mini.names import is_hidden, node_names, split
from ros2_mini.node_context import graph_node

Look: TypeAlias = Callable[[str, str], Sequence[tuple[str, list[str]]]]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of `ros2 node info`."""
    discovery.add_arguments(parser)
    parser.add_argument('node_name', help='Fully qualified node name to request information')
    parser.add_argument(
        '--include-hidden', action='store_true',
        help='Display hidden topics, services, and actions as well',
    )  # fmt: skip


def main(args: argparse.Namespace) -> int:
    """Print the interface of a node."""
    with graph_node(args.spin_time) as node:
        count = node_names(node, hidden=args.include_hidden).count(args.node_name)
        if count == 0:
            raise CommandError(f"Unable to find node '{args.node_name}'")
        if count > 1:
            print(
                f'There are {count} nodes in the graph with the exact name "{args.node_name}". '
                'You are seeing information about only one of them.',
                file=sys.stderr,
            )
        print(args.node_name)
        for heading, look in _sections(node).items():
            print(f'  {heading}:')
            lines = [
                f'    {name}: {", ".join(types)}'
                for name, types in look(*split(args.node_name))
                if args.include_hidden or not is_hidden(name)
            ]
            print('\n'.join(lines))
    return 0


def _sections(node: Node) -> dict[str, Look]:
    return {
        'Subscribers': node.get_subscriber_names_and_types_by_node,
        'Publishers': node.get_publisher_names_and_types_by_node,
        'Service Servers': node.get_service_names_and_types_by_node,
        'Service Clients': node.get_client_names_and_types_by_node,
        'Action Servers': partial(get_action_server_names_and_types_by_node, node),
        'Action Clients': partial(get_action_client_names_and_types_by_node, node),
    }
