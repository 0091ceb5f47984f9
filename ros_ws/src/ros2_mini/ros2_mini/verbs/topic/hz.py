# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""`ros2 topic hz`: the rate at which messages come."""

import argparse
import functools
from typing import Any

import rclpy
from rclpy.clock import Clock, ClockType
from rclpy.qos import qos_profile_sensor_data

from ros2_mini import discovery
from ros2_mini.interfaces import load_type
from ros2_mini.node_context import open_node
from ros2_mini.rate import RateMeter, Statistics, table
from ros2_mini.topics import topic_type

DEFAULT_WINDOW_SIZE = 10000
_FOREVER = float('inf')


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of `ros2 topic hz`."""
    discovery.add_arguments(parser, daemon=False)
    parser.add_argument('topic_name', nargs='+', help="Names of the ROS topics (e.g. '/chatter')")
    parser.add_argument(
        '-w', '--window', dest='window_size', metavar='WINDOW', type=int,
        default=DEFAULT_WINDOW_SIZE,
        help='window size, in # of messages, for calculating rate (default: %(default)s)',
    )  # fmt: skip
    parser.add_argument(
        '--wall-time', action='store_true', help='calculate the rate in wall time, without /clock'
    )


def main(args: argparse.Namespace) -> int:
    """Print the rate of each topic once a second until interrupted."""
    with open_node(use_sim_time=args.use_sim_time) as node:
        clock = Clock(clock_type=ClockType.SYSTEM_TIME) if args.wall_time else node.get_clock()
        meters = {topic: RateMeter(args.window_size) for topic in args.topic_name}
        for topic, meter in meters.items():
            type_name = topic_type(node, topic, args.spin_time)
            if type_name is None:
                print(f'WARNING: topic [{topic}] does not appear to be published yet')
                type_name = topic_type(node, topic, _FOREVER)
            if type_name is None:
                return 0  # shut down while waiting
            node.create_subscription(
                load_type(type_name, 'msg'),
                topic,
                functools.partial(_note, meter, clock),
                qos_profile_sensor_data,
                raw=True,  # only the arrival counts
            )
        node.create_timer(
            1.0,
            functools.partial(_report, meters),
            clock=Clock(clock_type=ClockType.STEADY_TIME),
        )
        rclpy.spin(node)
    return 0


def _note(meter: RateMeter, clock: Clock, message: Any) -> None:
    meter.add(clock.now().nanoseconds)


def _report(meters: dict[str, RateMeter]) -> None:
    news: dict[str, Statistics] = {}
    for topic, meter in meters.items():
        if (statistics := meter.take()) is not None:
            news[topic] = statistics
    if news:
        print(table(news) if len(meters) > 1 else next(iter(news.values())))
