# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""`ros2 service type`: the type of a service."""

import argparse

from ros2_mini import listing
from ros2_mini.node_context import graph_node


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of `ros2 service type`."""
    parser.add_argument('service_name', help="Name of the ROS service (e.g. '/set_flag')")


def main(args: argparse.Namespace) -> int:
    """Print the types of the service; print nothing and fail if there is no such service."""
    with graph_node() as node:
        return listing.print_types(node.get_service_names_and_types(), args.service_name)
