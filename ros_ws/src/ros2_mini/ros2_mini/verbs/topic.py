# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""`ros2 topic`: the topics in the graph, and the messages of one."""

import argparse
from collections.abc import Callable, Sequence
from functools import reduce
from typing import Any

import rclpy
from hexapod_node.raw_topics import matching_qos, message_class
from rclpy.exceptions import InvalidTopicNameException
from rclpy.expand_topic_name import expand_topic_name
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from rclpy.task import Future
from rclpy.topic_or_service_is_hidden import topic_or_service_is_hidden
from rclpy.validate_full_topic_name import validate_full_topic_name

from ros2_mini import discovery
from ros2_mini.errors import CommandError
from ros2_mini.message_text import message_to_yaml
from ros2_mini.node_context import graph_node, open_node

_TRUNCATE_LENGTH = 128


def _echo_arguments(parser: argparse.ArgumentParser) -> None:
    discovery.add_arguments(parser)
    parser.add_argument('topic_name', help="Name of the ROS topic (e.g. '/chatter')")
    parser.add_argument(
        'message_type', nargs='?', help="Type of the ROS message (e.g. 'std_msgs/msg/String')"
    )
    parser.add_argument(
        '--once', action='store_true', help='Print the first message received and then exit'
    )
    parser.add_argument('--field', help="Echo a selected field; use '.' to select sub-fields")
    parser.add_argument('--timeout', metavar='N', type=float, help='Give up after N seconds')
    parser.add_argument(
        '-f', '--full-length', action='store_true', help='Output long arrays and strings in full'
    )


def _echo(args: argparse.Namespace) -> int:
    """Print messages until interrupted, or the first one."""
    with open_node() as node:
        type_name = args.message_type or _type_of(node, args.topic_name, args.spin_time)
        if type_name is None:
            print(f'WARNING: topic [{args.topic_name}] does not appear to be published yet')
            raise CommandError('Could not determine the type for the passed topic')
        try:
            kind = message_class(type_name)
        except ValueError as error:
            raise CommandError(str(error)) from error
        publishers = node.get_publishers_info_by_topic(args.topic_name)
        qos = matching_qos(publishers) if publishers else qos_profile_sensor_data
        done = Future()
        node.create_subscription(kind, args.topic_name, _printer(args, done), qos)
        if args.once or args.timeout is not None:
            rclpy.spin_until_future_complete(node, done, timeout_sec=args.timeout)
        else:
            rclpy.spin(node)
    return 0


def _type_of(node: Node, topic: str, limit: float) -> str | None:
    """Return the name of a topic's type; None if the topic has not appeared within `limit` s.

    Raises:
        CommandError: If that is no valid name, or the topic has more than one type.
    """
    try:
        name = expand_topic_name(topic, node.get_name(), node.get_namespace())
        validate_full_topic_name(name)
    except (ValueError, InvalidTopicNameException) as error:
        raise CommandError(' '.join(str(error).split())) from error

    def look() -> list[str]:
        return dict(node.get_topic_names_and_types()).get(name, []) if rclpy.ok() else []

    types = discovery.wait_for(look, limit)
    if len(types) > 1:
        raise CommandError(
            f"Cannot use topic '{topic}', as it contains more than one type: [{', '.join(types)}]"
        )
    return types[0] if types else None


def _printer(args: argparse.Namespace, done: Future) -> Callable[[Any], None]:
    """Return the callback that prints a message, and ends the command where one is enough."""
    fields = [name for name in (args.field or '').split('.') if name]
    length = None if args.full_length else _TRUNCATE_LENGTH

    def print_message(message: Any) -> None:
        try:
            part = reduce(getattr, fields, message)
        except AttributeError as error:
            raise CommandError(f"Invalid field '{args.field}': {error}") from error
        text = message_to_yaml(part, length) if hasattr(part, 'SLOT_TYPES') else f'{part}\n'
        print(text, end='---\n')
        if args.once and not done.done():
            done.set_result(True)

    return print_message


def _list_arguments(parser: argparse.ArgumentParser) -> None:
    discovery.add_arguments(parser)
    for short, long, text in (
        ('-t', '--show-types', 'Additionally show the topic type'),
        ('-c', '--count-topics', 'Only display the number of topics discovered'),
        ('-v', '--verbose', 'List full details about each topic'),
    ):
        parser.add_argument(short, long, action='store_true', help=text)
    parser.add_argument(
        '--include-hidden-topics', action='store_true', help='Consider hidden topics as well'
    )


def _list(args: argparse.Namespace) -> int:
    """Print one topic a line, or the publishers and subscribers of each."""
    with graph_node(args.spin_time) as node:
        topics = sorted(
            (name, types)
            for name, types in node.get_topic_names_and_types()
            if args.include_hidden_topics or not topic_or_service_is_hidden(name)
        )
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


VERBS = {'echo': (_echo_arguments, _echo), 'list': (_list_arguments, _list)}
