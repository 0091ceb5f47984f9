# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""`ros2 bag info`: what a bag holds."""

import argparse
from pathlib import Path

from ros2_mini.bag.summary import found, summary


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of `ros2 bag info`."""
    parser.add_argument('bag_path', type=Path, help='Bag to open')
    parser.add_argument(
        '-s', '--storage', choices=('', 'mcap'), default='', help='Storage implementation of bag'
    )
    parser.add_argument('-t', '--topic-name', action='store_true', help='Only display topic names')


def main(args: argparse.Namespace) -> int:
    """Print the summary of a bag, or the names of its topics."""
    place, bag = found(args.bag_path)
    if args.topic_name:
        for topic in bag.topics:
            print(topic.name)
    else:
        print(summary(place, bag))
    return 0
