# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""`ros2 topic list`: the topics in the graph."""

import argparse
from collections.abc import Sequence

from ros2_mini import discovery
from ros2_mini.node_context import graph_node
from ros2_mini.topics import topic_names_and_types


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of `ros2 topic list`."""
    discovery.add_arguments(parser)
    parser.add_argument(
        '-t', '--show-types', action='store_true', help='Additionally show the topic type'
    )
    parser.add_argument(
        '-c', '--count-topics', action='store_true',
        help='Only display the number of topics discovered',
    )  # fmt: skip
    parser.add_argument(
        '--include-hidden-topics', action='store_true', help='Consider hidden topics as well'
    )
    parser.add_argument(
        '-v', '--verbose', action='store_true', help='List full details about each topic'
    )


def main(args: argparse.Namespace) -> int:
    """Print one topic a line, or the publishers and subscribers of each."""
    with graph_node(args.spin_time) as node:
        topics = topic_names_and_types(node, hidden=args.include_hidden_topics)
        publishers = [node.count_publishers(name) for name, _ in topics] if args.verbose else []
        subscribers = [node.count_subscribers(name) for name, _ in topics] if args.verbose else []
    if args.count_topics:
        print(len(topics))
    elif args.verbose:
        print(_details('Published', 'publisher', topics, publishers))
        print(_details('Subscribed', 'subscriber', topics, subscribers))
    else:
        for name, types in topics:
            print(f'{name} [{", ".join(types)}]' if args.show_types else name)
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
