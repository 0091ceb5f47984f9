# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""`ros2 bag`: what a bag holds, and its playback by the node `player` of hexapod_doe."""

import argparse
import datetime
import json
import os
from collections.abc import Sequence
from pathlib import Path

from hexapod_doe.bags.bag_file import BagFile
from hexapod_doe.bags.location import located
from hexapod_doe.bags.metadata import BagMetadata, read_metadata
from hexapod_doe.errors import BagError

from ros2_mini.errors import CommandError
from ros2_mini.packages import executable_path

_NANOSECONDS = 1_000_000_000
_INDENT = ' ' * 19  # the longest label, `Topic information:`, and a space


def found(path: Path) -> tuple[Path, BagMetadata]:
    """Return where a bag is, and what it says of itself; a bare file alone is opened for it.

    Raises:
        CommandError: there is no bag, or its metadata cannot be understood.
    """
    try:
        place = located(path)
        return place, read_metadata(place) if place.is_dir() else BagFile(place).about
    except BagError as error:
        raise CommandError(str(error)) from error


def summary(path: Path, bag: BagMetadata) -> str:
    """Return the text that `ros2 bag info` prints, times in the local zone."""
    files = [path] if path.is_file() else [file for file in path.rglob('*') if file.is_file()]
    topics = [
        f'Topic: {topic.name} | Type: {topic.type_name} | Count: {topic.count} | '
        f'Serialization Format: {topic.encoding}'
        for topic in bag.topics
    ]
    return '\n'.join(
        [
            '',
            f'Files:             {_lines(bag.files)}',
            f'Bag size:          {_size(sum(file.stat().st_size for file in files))}',
            f'Storage id:        {bag.storage}',
            f'ROS Distro:        {bag.distro or "unknown"}',
            f'Duration:          {_seconds(bag.duration_ns)}s',
            f'Start:             {_date(bag.start_ns)}',
            f'End:               {_date(bag.start_ns + bag.duration_ns)}',
            f'Messages:          {bag.message_count}',
            f'Topic information: {_lines(topics)}',
            'Service:           0',
            'Service information: ',
        ]
    )


def _lines(items: Sequence[str]) -> str:
    return f'\n{_INDENT}'.join(items)


def _size(count: int) -> str:
    size = float(count)
    for unit in ('B', 'KiB', 'MiB', 'GiB'):
        if size < 1024:
            return f'{size:.0f} {unit}' if unit == 'B' else f'{size:.1f} {unit}'
        size /= 1024
    return f'{size:.1f} TiB'


def _seconds(nanoseconds: int) -> str:
    seconds, rest = divmod(nanoseconds, _NANOSECONDS)
    return f'{seconds}.{rest:09d}'


def _date(nanoseconds: int) -> str:
    seconds, rest = divmod(nanoseconds, _NANOSECONDS)
    date = datetime.datetime.fromtimestamp(seconds)
    return f'{date:%b %e %Y %H:%M:%S}.{rest:09d} ({_seconds(nanoseconds)})'


# The original waits for nobody; here subscribers find the player in that time [s].
_DISCOVERY = 2.0


def _bag_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('bag_path', type=Path, help='Bag to open')
    parser.add_argument(
        '-s', '--storage', choices=('', 'mcap'), default='', help='Storage implementation of bag'
    )


def _info_arguments(parser: argparse.ArgumentParser) -> None:
    _bag_arguments(parser)
    parser.add_argument('-t', '--topic-name', action='store_true', help='Only display topic names')


def _info(args: argparse.Namespace) -> int:
    """Print the summary of a bag, or the names of its topics."""
    place, bag = found(args.bag_path)
    if args.topic_name:
        for topic in bag.topics:
            print(topic.name)
    else:
        print(summary(place, bag))
    return 0


def _play_arguments(parser: argparse.ArgumentParser) -> None:
    _bag_arguments(parser)
    parser.add_argument(
        '-r', '--rate', type=_positive, default=1.0,
        help='rate at which to play back messages. Valid range > 0.0.',
    )  # fmt: skip
    parser.add_argument(
        '--topics', nargs='+', default=[], metavar='topic',
        help='Space-delimited list of topics to play.',
    )  # fmt: skip
    parser.add_argument(
        '-l', '--loop', action='store_true', help='start again at the end, indefinitely'
    )
    parser.add_argument(
        '-m', '--remap', nargs='+', default=[], metavar='old:=new', help='topics to be remapped'
    )
    parser.add_argument(
        '--clock', action='store_true', help='Publish the time of what is played on /clock'
    )
    parser.add_argument(
        '-d', '--delay', type=_positive, default=_DISCOVERY, help='Sleep before play [s]'
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


def _play(args: argparse.Namespace) -> int:
    """Become the player; return only if the bag cannot be played."""
    try:
        bag = BagFile(args.bag_path)
    except BagError as error:
        raise CommandError(str(error)) from error
    for name in args.topics:
        if name not in bag.types:
            known = ', '.join(sorted(bag.types))
            raise CommandError(f"bag '{bag.path}' has no topic '{name}'; it has: {known}")
    player = str(executable_path('hexapod_doe', 'player_node'))
    settings = {
        'bag': str(bag.path), 'rate': args.rate, 'loop': args.loop, 'clock': args.clock,
        'topics': ' '.join(args.topics), 'delay': args.delay, 'start': args.start_offset,
    }  # fmt: skip
    words = [word for rule in args.remap for word in ('-r', rule)]
    for name, value in settings.items():
        words += ['-p', f'{name}:={json.dumps(value)}']  # JSON is YAML whose texts stay texts
    os.execv(player, [player, '--ros-args', '-r', '__node:=rosbag2_player', *words])


VERBS = {'info': (_info_arguments, _info), 'play': (_play_arguments, _play)}
