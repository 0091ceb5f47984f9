# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""`ros2 topic pub`: publish a message, once or at a rate."""

import argparse
import time
from typing import Any

import rclpy
from rclpy.node import Node
from rclpy.publisher import Publisher

from ros2_mini import qos
from ros2_mini.discovery import wait_for
from ros2_mini.errors import CommandError
from ros2_mini.interfaces import load_type
from ros2_mini.message_fill import (
    StampSetter,
    add_values_argument,
    fill_message,
    given_values,
)
from ros2_mini.node_context import open_node


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of `ros2 topic pub`."""
    parser.add_argument('topic_name', help="Name of the ROS topic (e.g. '/chatter')")
    parser.add_argument('message_type', help="Type of the ROS message (e.g. 'std_msgs/String')")
    add_values_argument(
        parser,
        'values',
        "Values to fill the message with in YAML format (e.g. 'data: Hello World')",
    )
    parser.add_argument(
        '-r', '--rate', metavar='N', type=_positive, default=1.0, help='Rate in Hz (default: 1)'
    )
    parser.add_argument(
        '-p', '--print', metavar='N', type=int, default=1,
        help='Only print every N-th published message (default: 1)',
    )  # fmt: skip
    count = parser.add_mutually_exclusive_group()
    count.add_argument('-1', '--once', action='store_true', help='Publish one message and exit')
    count.add_argument('-t', '--times', type=int, default=0, help='Publish so often, then exit')
    parser.add_argument(
        '-w', '--wait-matching-subscriptions', type=int, metavar='N',
        help='Wait for N subscriptions (default: 1 with --once or --times, else 0)',
    )  # fmt: skip
    parser.add_argument(
        '--max-wait-time-secs', type=_positive, metavar='N', help='Wait no longer than N seconds'
    )
    parser.add_argument(
        '--keep-alive', metavar='N', type=_positive, default=0.1,
        help='Keep the node alive for N seconds after the last message (default: 0.1)',
    )  # fmt: skip
    parser.add_argument('-n', '--node-name', help='Name of the created publishing node')
    parser.add_argument(
        '-s', '--use-sim-time', action='store_true', help='Enable ROS simulation time'
    )
    qos.add_arguments(parser, 'default')


def _positive(text: str) -> float:
    value = float(text)
    if value <= 0.0:
        raise argparse.ArgumentTypeError('Value must be positive')
    return value


def main(args: argparse.Namespace) -> int:
    """Publish until interrupted, or as often as asked."""
    message = load_type(args.message_type, 'msg')()
    stamps = fill_message(message, given_values(args))
    with open_node(args.node_name, use_sim_time=args.use_sim_time) as node:
        publisher = node.create_publisher(type(message), args.topic_name, qos.profile(args))
        _wait_for_subscriptions(publisher, args)
        _publish(node, publisher, message, stamps, args)
        time.sleep(args.keep_alive)
    return 0


def _wait_for_subscriptions(publisher: Publisher, args: argparse.Namespace) -> None:
    wanted = args.wait_matching_subscriptions
    if wanted is None:
        wanted = int(args.once or args.times > 0)
    deadline = time.monotonic() + (args.max_wait_time_secs or float('inf'))
    while publisher.get_subscription_count() < wanted:
        print(f'Waiting for at least {wanted} matching subscription(s)...')
        if time.monotonic() >= deadline:
            raise CommandError(
                f'Timed out waiting for subscribers: Expected {wanted} subscribers but only got '
                f'{publisher.get_subscription_count()} subscribers'
            )
        wait_for(lambda: publisher.get_subscription_count() >= wanted, 1.0)


def _publish(
    node: Node,
    publisher: Publisher,
    message: Any,
    stamps: list[StampSetter],
    args: argparse.Namespace,
) -> None:
    times = 1 if args.once else args.times
    count = 0

    def publish() -> None:
        nonlocal count
        for set_stamp in stamps:
            set_stamp(node.get_clock().now().to_msg())
        count += 1
        if args.print and count % args.print == 0:
            print(f'publishing #{count}: {message!r}\n')
        publisher.publish(message)

    print('publisher: beginning loop')
    publish()
    node.create_timer(1.0 / args.rate, publish)
    while times == 0 or count < times:
        rclpy.spin_once(node)
