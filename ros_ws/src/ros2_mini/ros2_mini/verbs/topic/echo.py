# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""`ros2 topic echo`: print the messages of a topic."""

import argparse
from collections.abc import Callable
from functools import reduce
from typing import Any

import rclpy
from rclpy.node import Node
from rclpy.task import Future

from ros2_mini import discovery, qos
from ros2_mini.errors import CommandError
from ros2_mini.interfaces import load_type
from ros2_mini.message_text import message_to_csv, message_to_yaml
from ros2_mini.node_context import open_node
from ros2_mini.topics import topic_type

DEFAULT_TRUNCATE_LENGTH = 128


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of `ros2 topic echo`."""
    discovery.add_arguments(parser)
    parser.add_argument('topic_name', help="Name of the ROS topic (e.g. '/chatter')")
    parser.add_argument(
        'message_type', nargs='?', help="Type of the ROS message (e.g. 'std_msgs/msg/String')"
    )
    qos.add_arguments(parser, 'sensor_data')
    flags = {
        '--csv': 'Output all recursive fields separated by commas',
        '--no-arr': "Don't print array fields of messages",
        '--no-str': "Don't print string fields of messages",
        '--once': 'Print the first message received and then exit',
        '--raw': 'Echo the raw binary representation',
    }
    for flag, text in flags.items():
        parser.add_argument(flag, action='store_true', help=text)
    parser.add_argument('--field', help="Echo a selected field; use '.' to select sub-fields")
    parser.add_argument('--timeout', metavar='N', type=float, help='Give up after N seconds')
    parser.add_argument(
        '-f', '--full-length', action='store_true', help='Output long arrays and strings in full'
    )
    parser.add_argument(
        '-l', '--truncate-length', type=int, default=DEFAULT_TRUNCATE_LENGTH,
        help='The length to truncate arrays, bytes, and string to (default: %(default)s)',
    )  # fmt: skip


def main(args: argparse.Namespace) -> int:
    """Print messages until interrupted, or the first one."""
    with open_node(use_sim_time=args.use_sim_time) as node:
        type_name = args.message_type or topic_type(node, args.topic_name, args.spin_time)
        if type_name is None:
            print(f'WARNING: topic [{args.topic_name}] does not appear to be published yet')
            raise CommandError('Could not determine the type for the passed topic')
        done = Future()
        node.create_subscription(
            load_type(type_name, 'msg'),
            args.topic_name,
            _printer(args, done),
            qos.matching_profile(args, node, args.topic_name),
            raw=args.raw,
        )
        _spin(node, done, args)
    return 0


def _spin(node: Node, done: Future, args: argparse.Namespace) -> None:
    if args.once or args.timeout is not None:
        rclpy.spin_until_future_complete(node, done, timeout_sec=args.timeout)
    else:
        rclpy.spin(node)


def _printer(args: argparse.Namespace, done: Future) -> Callable[[Any], None]:
    """Return the callback that prints a message, and ends the command where one is enough."""
    fields = [name for name in (args.field or '').split('.') if name]
    options = {
        'truncate_length': None if args.full_length else args.truncate_length,
        'no_arr': args.no_arr,
        'no_str': args.no_str,
    }

    def print_message(message: Any) -> None:
        try:
            part = reduce(getattr, fields, message)
        except AttributeError as error:
            raise CommandError(f"Invalid field '{args.field}': {error}") from error
        if not hasattr(part, 'SLOT_TYPES'):
            print(part, end='\n---\n')
        elif args.csv:
            print(message_to_csv(part, **options))
        else:
            print(message_to_yaml(part, **options), end='---\n')
        if args.once and not done.done():
            done.set_result(True)

    return print_message
