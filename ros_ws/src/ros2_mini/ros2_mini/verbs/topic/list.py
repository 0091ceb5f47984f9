# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""`ros2 topic list`: the topics in the graph."""

import argparse
from collections.abc import Sequence

from ros2_mini import discovery, listing
from ros2_mini.node_context import graph_node
from ros2_mini.topics import topic_names_and_types


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of `ros2 topic list`."""
    discovery.add_arguments(parser)
    listing.add_types_argument(parser, 'topic')
    listing.add_count_argument(parser, 'topic')
    listing.add_hidden_argument(parser, 'topic')
    parser.add_argument(
        '-v', '--verbose', action='store_true', help='List full details about each topic'
    )


def main(args: argparse.Namespace) -> int:
    """Print one topic a line, or the publishers and subscribers of each."""
    with graph_node(args.spin_time) as node:
        topics = topic_names_and_types(node, hidden=args.hidden)
        publishers = [node.count_publishers(name) for name, _ in topics] if args.verbose else []
        subscribers = [node.count_subscribers(name) for name, _ in topics] if args.verbose else []
    if args.verbose and not args.count:
        print(_details('Published', 'publisher', topics, publishers))
        print(_details('Subscribed', 'subscriber', topics, subscribers))
    else:
        listing.print_names(topics, args)
    return 0


def _details(
    heading: str, role: str, topics: Sequence[tuple[str, list[str]]], counts: Sequence[int]
) -> str:
    lines = [f'{heading} topics:']
    for (name, types), count in zip(topics, counts, strict=True):
        if count:
            plural = 's' if count > 1 else ''
            lines.append(f' * {name} [{", ".join(types)}] {count} {role}{plural}')
    return '\n'.join(lines) + '\n'
