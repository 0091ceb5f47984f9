# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""`ros2 bag play`: publish what a bag holds.

Unlike the original, it first waits until it knows who is listening, so that they get the first
messages too.
"""

import argparse
import contextlib
import time
from pathlib import Path

import rclpy
from hexapod_doe.bags.bag_file import BagFile
from hexapod_doe.bags.selection import Selection, select
from hexapod_doe.errors import BagError
from hexapod_node.raw_topics import message_class
from rclpy.node import Node

from ros2_mini.bag.player import Pace, Player
from ros2_mini.discovery import DEFAULT_LIMIT, wait_until_settled
from ros2_mini.errors import CommandError
from ros2_mini.node_context import open_node

_CLOCK_TOPIC = '/clock'
_CLOCK_RATE = 40.0
_NODE_NAME = 'rosbag2_player'


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of `ros2 bag play`."""
    parser.add_argument('bag_path', type=Path, help='Bag to open')
    parser.add_argument(
        '-s', '--storage', choices=('', 'mcap'), default='', help='Storage implementation of bag'
    )
    parser.add_argument(
        '-r', '--rate', type=_positive, default=1.0,
        help='rate at which to play back messages. Valid range > 0.0.',
    )  # fmt: skip
    parser.add_argument(
        '--topics', nargs='+', metavar='topic', help='Space-delimited list of topics to play.'
    )
    parser.add_argument(
        '--exclude-topics', nargs='+', default=[], metavar='topic',
        help='Space-delimited list of topics not to play.',
    )  # fmt: skip
    parser.add_argument(
        '-l', '--loop', action='store_true', help='start again at the end, indefinitely'
    )
    parser.add_argument(
        '-m', '--remap', nargs='+', default=[], metavar='old:=new', help='topics to be remapped'
    )
    parser.add_argument(
        '--clock', type=_positive, nargs='?', const=_CLOCK_RATE, default=0.0,
        help='Publish to /clock at a specific frequency in Hz (default: %(const)s)',
    )  # fmt: skip
    parser.add_argument(
        '-d', '--delay', type=_positive, default=0.0, help='Sleep before play (each loop) [s]'
    )
    parser.add_argument(
        '--start-offset', type=float, default=0.0, help='Start so many seconds into the bag'
    )
    parser.add_argument(
        '--disable-keyboard-controls', action='store_true', help='Accepted; there are none here'
    )


def _positive(text: str) -> float:
    value = float(text)
    if value <= 0.0:
        raise argparse.ArgumentTypeError(f'{text} is not in the valid range (> 0.0)')
    return value


def main(args: argparse.Namespace) -> int:
    """Play a bag to its end, or until interrupted."""
    try:
        _run(args)
    except BagError as error:
        raise CommandError(str(error)) from error
    return 0


def _run(args: argparse.Namespace) -> None:
    bag = BagFile(args.bag_path)
    selection = select(bag, _chosen(bag, args), message_class)
    remaps = [word for rule in args.remap for word in ('--remap', rule)]
    cli_args = ['--ros-args', *remaps] if remaps else []
    with (
        contextlib.suppress(KeyboardInterrupt, SystemExit),
        open_node(_NODE_NAME, cli_args=cli_args) as node,
    ):
        _play(node, selection, args)


def _chosen(bag: BagFile, args: argparse.Namespace) -> list[str]:
    """Return the topics to play; the recorded clock gives way to one of ours."""
    for name in args.topics or []:
        if name not in bag.types:
            known = ', '.join(sorted(bag.types))
            raise CommandError(f"bag '{bag.path}' has no topic '{name}'; it has: {known}")
    left_out = {*args.exclude_topics, *([_CLOCK_TOPIC] if args.clock else [])}
    wanted = set(args.topics or bag.types) - left_out
    return [name for name in bag.types if name in wanted]


def _play(node: Node, selection: Selection, args: argparse.Namespace) -> None:
    for line in selection.warnings():
        node.get_logger().warning(line)
    player = Player(node, selection, Pace(args.rate, args.start_offset, args.clock))
    wait_until_settled(node, DEFAULT_LIMIT)
    while rclpy.ok():
        time.sleep(args.delay)
        player.play()
        if not args.loop:
            return
