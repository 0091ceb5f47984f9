# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""`ros2 node`: the nodes in the graph, and the topics, services and actions of one."""

import argparse
import sys
from collections.abc import Callable, Sequence
from functools import partial

from rclpy.action import (
    get_action_client_names_and_types_by_node,
    get_action_server_names_and_types_by_node,
)

from ros2_mini import discovery
from ros2_mini.errors import CommandError
from ros2_mini.names import is_hidden, node_names
from ros2_mini.node_context import graph_node


def _info_arguments(parser: argparse.ArgumentParser) -> None:
    discovery.add_arguments(parser)
    parser.add_argument('node_name', help='Fully qualified node name to request information')
    parser.add_argument(
        '--include-hidden', action='store_true',
        help='Display hidden topics, services, and actions as well',
    )  # fmt: skip


def _info(args: argparse.Namespace) -> int:
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
        namespace, _, own_name = args.node_name.rpartition('/')
        sections: dict[str, Callable[[str, str], Sequence[tuple[str, list[str]]]]] = {
            'Subscribers': node.get_subscriber_names_and_types_by_node,
            'Publishers': node.get_publisher_names_and_types_by_node,
            'Service Servers': node.get_service_names_and_types_by_node,
            'Service Clients': node.get_client_names_and_types_by_node,
            'Action Servers': partial(get_action_server_names_and_types_by_node, node),
            'Action Clients': partial(get_action_client_names_and_types_by_node, node),
        }
        for heading, look in sections.items():
            print(f'  {heading}:')
            lines = [
                f'    {name}: {", ".join(types)}'
                for name, types in look(own_name, namespace or '/')
                if args.include_hidden or not is_hidden(name)
            ]
            print('\n'.join(lines))
    return 0


def _list_arguments(parser: argparse.ArgumentParser) -> None:
    discovery.add_arguments(parser)
    parser.add_argument(
        '-a', '--all', action='store_true', help='Display all nodes even hidden ones'
    )
    parser.add_argument(
        '-c', '--count-nodes', action='store_true',
        help='Only display the number of nodes discovered',
    )  # fmt: skip


def _list(args: argparse.Namespace) -> int:
    """Print one node name a line."""
    with graph_node(args.spin_time) as node:
        names = node_names(node, hidden=args.all)
    if args.count_nodes:
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


VERBS = {'info': (_info_arguments, _info), 'list': (_list_arguments, _list)}
