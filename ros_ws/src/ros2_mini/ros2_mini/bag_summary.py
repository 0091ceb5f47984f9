# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The summary that `ros2 bag info` prints of a bag."""

import datetime
from collections.abc import Sequence
from pathlib import Path

from hexapod_doe.bags.bag_file import BagFile
from hexapod_doe.bags.location import located
from hexapod_doe.bags.metadata import BagMetadata, read_metadata
from hexapod_doe.errors import BagError

from ros2_mini.errors import CommandError

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
