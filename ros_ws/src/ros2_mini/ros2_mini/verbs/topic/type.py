# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""`ros2 topic type`: the type of a topic."""

import argparse

from ros2_mini import discovery, listing
from ros2_mini.node_context import graph_node


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of `ros2 topic type`."""
    discovery.add_arguments(parser)
    parser.add_argument('topic_name', help="Name of the ROS topic (e.g. '/chatter')")


def main(args: argparse.Namespace) -> int:
    """Print the types of the topic; print nothing and fail if there is no such topic."""
    with graph_node(args.spin_time) as node:
        return listing.print_types(node.get_topic_names_and_types(), args.topic_name)
