# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The `metadata.yaml` of a bag, and the summary that `ros2 bag info` prints of it."""

import datetime
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from ros2_mini.errors import CommandError

FILE_NAME = 'metadata.yaml'
_NANOSECONDS = 1_000_000_000
_INDENT = ' ' * 19  # the longest label, `Topic information:`, and a space


@dataclass(frozen=True)
class Topic:
    """One recorded topic."""

    name: str
    type: str
    serialization_format: str
    message_count: int
    offers: list[dict[str, Any]]
    """QoS profiles that its publishers offered, as written in the file."""


@dataclass(frozen=True)
class BagMetadata:
    """What `metadata.yaml` says of a bag; times in nanoseconds."""

    directory: Path
    files: list[str]
    storage: str
    compression: str
    """How whole files or single messages are compressed outside the storage; empty for not."""
    distro: str
    start: int
    duration: int
    message_count: int
    topics: list[Topic]


def read_metadata(directory: Path) -> BagMetadata:
    """Return the metadata of a bag.

    Raises:
        CommandError: If the bag or its metadata is missing, or cannot be understood.
    """
    if not directory.exists():
        raise CommandError(f"Bag path '{directory}' does not exist!")
    path = directory / FILE_NAME
    try:
        content = yaml.safe_load(path.read_text(encoding='utf-8'))
        return _metadata(directory, content['rosbag2_bagfile_information'])
    except OSError as error:
        raise CommandError(f"'{directory}' is no bag: it has no readable {FILE_NAME}") from error
    except yaml.YAMLError as error:
        raise CommandError(f"'{path}' is no YAML: {' '.join(str(error).split())}") from error
    except (KeyError, TypeError) as error:
        raise CommandError(f"'{path}' is no metadata of a bag: it lacks {error}") from error


def _metadata(directory: Path, info: dict[str, Any]) -> BagMetadata:
    return BagMetadata(
        directory=directory,
        files=info['relative_file_paths'],
        storage=info['storage_identifier'],
        compression=info.get('compression_mode', ''),
        distro=info.get('ros_distro') or 'unknown',
        start=info['starting_time']['nanoseconds_since_epoch'],
        duration=info['duration']['nanoseconds'],
        message_count=info['message_count'],
        topics=[_topic(entry) for entry in info['topics_with_message_count']],
    )


def _topic(entry: dict[str, Any]) -> Topic:
    metadata = entry['topic_metadata']
    offers = metadata.get('offered_qos_profiles') or []
    return Topic(
        name=metadata['name'],
        type=metadata['type'],
        serialization_format=metadata['serialization_format'],
        message_count=entry['message_count'],
        # Up to version 8 of the format the profiles are YAML within a string.
        offers=yaml.safe_load(offers) or [] if isinstance(offers, str) else offers,
    )


def summary(bag: BagMetadata) -> str:
    """Return the text that `ros2 bag info` prints, times in the local zone."""
    size = sum(file.stat().st_size for file in bag.directory.rglob('*') if file.is_file())
    topics = [
        f'Topic: {topic.name} | Type: {topic.type} | Count: {topic.message_count} | '
        f'Serialization Format: {topic.serialization_format}'
        for topic in bag.topics
    ]
    return '\n'.join(
        [
            '',
            f'Files:             {_lines(bag.files)}',
            f'Bag size:          {_size(size)}',
            f'Storage id:        {bag.storage}',
            f'ROS Distro:        {bag.distro}',
            f'Duration:          {_seconds(bag.duration)}s',
            f'Start:             {_date(bag.start)}',
            f'End:               {_date(bag.start + bag.duration)}',
            f'Messages:          {bag.message_count}',
            f'Topic information: {_lines(topics)}',
            'Service:           0',
            'Service information: ',
        ]
    )


def _lines(items: list[str]) -> str:
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
