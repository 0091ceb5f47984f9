# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""`ros2 service list`: the services in the graph."""

import argparse

from rclpy.topic_or_service_is_hidden import topic_or_service_is_hidden

from ros2_mini import discovery, listing
from ros2_mini.node_context import graph_node


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of `ros2 service list`."""
    discovery.add_arguments(parser)
    listing.add_types_argument(parser, 'service')
    listing.add_count_argument(parser, 'service')
    listing.add_hidden_argument(parser, 'service')


def main(args: argparse.Namespace) -> int:
    """Print one service a line."""
    with graph_node(args.spin_time) as node:
        services = sorted(
            (name, types)
            for name, types in node.get_service_names_and_types()
            if args.hidden or not topic_or_service_is_hidden(name)
        )
    listing.print_names(services, args)
    return 0
