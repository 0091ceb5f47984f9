# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""`ros2 topic info`: type, publishers and subscriptions of a topic."""

import argparse

from ros2_mini import discovery
from ros2_mini.errors import CommandError
from ros2_mini.node_context import graph_node


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of `ros2 topic info`."""
    discovery.add_arguments(parser)
    parser.add_argument('topic_name', help="Name of the ROS topic (e.g. '/chatter')")
    parser.add_argument(
        '-v', '--verbose', action='store_true',
        help='Print node, type, type hash, GUID and QoS profile of each publisher and subscriber',
    )  # fmt: skip


def main(args: argparse.Namespace) -> int:
    """Print what the graph knows about the topic."""
    topic = args.topic_name
    end = '\n\n' if args.verbose else '\n'
    with graph_node(args.spin_time) as node:
        types = dict(node.get_topic_names_and_types()).get(topic)
        if types is None:
            raise CommandError(f"Unknown topic '{topic}'")
        print(f'Type: {types[0] if len(types) == 1 else types}', end=end)
        print(f'Publisher count: {node.count_publishers(topic)}', end=end)
        if args.verbose:
            for info in node.get_publishers_info_by_topic(topic):
                print(info, end=end)
        print(f'Subscription count: {node.count_subscribers(topic)}', end=end)
        if args.verbose:
            for info in node.get_subscriptions_info_by_topic(topic):
                print(info, end=end)
    return 0
