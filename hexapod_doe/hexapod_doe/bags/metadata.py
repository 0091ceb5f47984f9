# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What a bag says of itself: its metadata.yaml, or the sums of a bare MCAP file."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from hexapod_doe.bags.mcap_file import Contents, full_name
from hexapod_doe.bags.rosbag2 import METADATA_FILE, ROOT_KEY, VERSION, OfferedQos, offered_qos
from hexapod_doe.errors import BagError

YAML_LOADER = getattr(yaml, 'CSafeLoader', yaml.SafeLoader)
"""The fast one where there is one."""
_NO_COMPRESSION = ('', 'none')
_FOREIGN = (KeyError, TypeError, AttributeError, ValueError, yaml.YAMLError)


@dataclass(frozen=True)
class ListedTopic:
    """A topic as metadata.yaml lists it."""

    name: str
    type_name: str
    encoding: str
    """Of its messages: 'cdr' as a rule."""
    count: int
    """Messages."""
    qos: tuple[OfferedQos, ...]
    type_hash: str
    """RIHS01 hash of the type; '' where there is none."""


@dataclass(frozen=True)
class BagMetadata:
    """What a bag says that it holds; times in nanoseconds."""

    files: tuple[str, ...]
    storage: str
    compression: str
    """What files or messages are compressed with outside the storage; '' for nothing."""
    distro: str
    """ROS distribution of the recorder; '' where it is not told."""
    start_ns: int
    duration_ns: int
    message_count: int
    topics: tuple[ListedTopic, ...]


def read_metadata(bag: Path) -> BagMetadata:
    """Read the metadata.yaml of a directory.

    Raises:
        BagError: it is not that of rosbag2.
    """
    try:
        text = (bag / METADATA_FILE).read_text(encoding='utf-8')
        information = yaml.load(text, Loader=YAML_LOADER)[ROOT_KEY]
        version = information['version']
    except OSError as error:
        raise BagError(f'bag {bag}: {METADATA_FILE} cannot be read ({error})') from error
    except _FOREIGN as error:
        raise _foreign(bag, 'is not that of rosbag2') from error
    try:
        return _metadata(information)
    except _FOREIGN as error:
        what = f'lacks {error}' if isinstance(error, KeyError) else f'has an odd entry ({error})'
        newer = f', and is of version {version}, newer than {VERSION}' if _newer(version) else ''
        raise _foreign(bag, ' '.join(f'{what}{newer}'.split())) from error


def bare_metadata(file: Path, contents: Contents) -> BagMetadata:
    """Return what the sums of an MCAP file by itself tell."""
    extent = contents.extent
    topics = {
        topic.name: ListedTopic(
            topic.name,
            topic.type_name,
            topic.encoding,
            extent.counts.get(topic.name, 0),
            offered_qos(topic.qos),
            '',
        )
        for topic in contents.topics
    }
    return BagMetadata(
        files=(file.name,),
        storage='mcap',
        compression='',
        distro='',
        start_ns=extent.start_ns,
        duration_ns=extent.end_ns - extent.start_ns,
        message_count=extent.messages,
        topics=tuple(topics.values()),
    )


def _metadata(information: Mapping[str, Any]) -> BagMetadata:
    mode = str(information.get('compression_mode') or '')
    packed = mode.lower() not in _NO_COMPRESSION
    return BagMetadata(
        files=tuple(str(name) for name in information['relative_file_paths']),
        storage=str(information['storage_identifier']),
        compression=str(information.get('compression_format') or '') if packed else '',
        distro=str(information.get('ros_distro') or ''),
        start_ns=int(information['starting_time']['nanoseconds_since_epoch']),
        duration_ns=int(information['duration']['nanoseconds']),
        message_count=int(information['message_count']),
        topics=tuple(_topic(entry) for entry in information['topics_with_message_count']),
    )


def _topic(entry: Mapping[str, Any]) -> ListedTopic:
    metadata = entry['topic_metadata']
    return ListedTopic(
        name=str(metadata['name']),
        type_name=full_name(str(metadata['type'])),
        encoding=str(metadata.get('serialization_format') or 'cdr'),
        count=int(entry['message_count']),
        qos=offered_qos(metadata.get('offered_qos_profiles') or ()),
        type_hash=str(metadata.get('type_description_hash') or ''),
    )


def _newer(version: Any) -> bool:
    return isinstance(version, int) and version > VERSION


def _foreign(bag: Path, reason: str) -> BagError:
    return BagError(
        f'bag {bag}: {METADATA_FILE} {reason}, expected that of a rosbag2 directory with MCAP '
        'storage; cure: `ros2 bag reindex` it, or give one of its .mcap files'
    )
