# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""`ros2 service list`: the services in the graph."""

import argparse

from rclpy.topic_or_service_is_hidden import topic_or_service_is_hidden

from ros2_mini import discovery
from ros2_mini.node_context import graph_node


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of `ros2 service list`."""
    discovery.add_arguments(parser)
    parser.add_argument(
        '-t', '--show-types', action='store_true', help='Additionally show the service type'
    )
    parser.add_argument(
        '-c', '--count-services', action='store_true',
        help='Only display the number of services discovered',
    )  # fmt: skip
    parser.add_argument(
        '--include-hidden-services', action='store_true', help='Consider hidden services as well'
    )


def main(args: argparse.Namespace) -> int:
    """Print one service a line."""
    with graph_node(args.spin_time) as node:
        services = sorted(
            (name, types)
            for name, types in node.get_service_names_and_types()
            if args.include_hidden_services or not topic_or_service_is_hidden(name)
        )
    if args.count_services:
        print(len(services))
        return 0
    for name, types in services:
        print(f'{name} [{", ".join(types)}]' if args.show_types else name)
    return 0
