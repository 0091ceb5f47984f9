# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""One MCAP file of a bag: how to open it, and what it says of its topics and their messages."""

import os
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from tempfile import NamedTemporaryFile
from typing import IO, NamedTuple

from mcap.exceptions import UnsupportedCompressionError
from mcap.reader import McapReader
from mcap.records import Channel, Chunk, McapRecord, Message, Schema
from mcap.stream_reader import StreamReader, breakup_chunk
from mcap.writer import MCAP0_MAGIC
from zstandard import ZstdDecompressor

from hexapod_doe.bags.rosbag2 import Extent

SUFFIX = '.mcap'
PACKED_SUFFIX = '.zstd'
"""What rosbag2 adds to the name of a file that it compressed as a whole."""
_CHUNK_COMPRESSIONS = ('', 'lz4', 'zstd')


class RecordedTopic(NamedTuple):
    """How one channel of a file was recorded."""

    name: str
    type_name: str
    """Such as 'sensor_msgs/msg/Imu'; empty without a schema."""
    encoding: str
    """Of the messages: 'cdr' for ROS 2."""
    definition: bytes
    """Text of the type as it was then; empty where the file has none."""
    definition_encoding: str
    """Language of the text: 'ros2msg' or 'ros2idl' for ROS 2."""
    qos: str
    """What its publishers offered, as rosbag2 writes it."""


@dataclass(frozen=True)
class Contents:
    """What a file holds."""

    topics: tuple[RecordedTopic, ...]
    extent: Extent


def is_mcap(path: Path) -> bool:
    """Whether a name is that of an MCAP file, packed or not."""
    return path.name.removesuffix(PACKED_SUFFIX).endswith(SUFFIX)


def unpacked(file: Path) -> IO[bytes]:
    """Return a temporary file with what rosbag2 compressed as a whole; it goes when it is closed.

    Raises:
        zstandard.ZstdError: the file is damaged.
        OSError: it cannot be read, or there is no room for its content.
    """
    copy = NamedTemporaryFile(prefix='hexapod_bag_', suffix=SUFFIX)  # noqa: SIM115
    with file.open('rb') as packed:
        ZstdDecompressor().copy_stream(packed, copy)
    copy.flush()
    return copy


def check_ends(stream: IO[bytes]) -> None:
    """Raise ValueError unless a file begins and ends as MCAP does."""
    size = stream.seek(0, os.SEEK_END)
    if size == 0:
        raise ValueError('empty')
    stream.seek(0)
    if stream.read(len(MCAP0_MAGIC)) != MCAP0_MAGIC:
        raise ValueError('not MCAP: it does not begin so')
    stream.seek(max(0, size - len(MCAP0_MAGIC)))
    if stream.read() != MCAP0_MAGIC or size < 2 * len(MCAP0_MAGIC):
        raise ValueError('cut short: it does not end as MCAP does')
    stream.seek(0)


def summed_up(reader: McapReader) -> Contents | None:
    """Return what the summary of a file says; None where it has no sums.

    Raises:
        UnsupportedCompressionError: its chunks are compressed in an unknown way.
    """
    summary = reader.get_summary()
    if summary is None or summary.statistics is None:
        return None
    for chunk in summary.chunk_indexes:
        _check_compression(chunk.compression)
    sums = summary.statistics
    counts: Counter[str] = Counter()
    for number, count in sums.channel_message_counts.items():
        counts[summary.channels[number].topic] += count
    topics = tuple(_recorded(c, summary.schemas) for c in summary.channels.values())
    times = (sums.message_start_time, sums.message_end_time)
    return Contents(topics, Extent(dict(counts), sums.message_count, *times))


def gone_through(stream: IO[bytes]) -> Contents:
    """Return what a file without a summary holds, read from its begin to its end.

    Raises:
        UnsupportedCompressionError: its chunks are compressed in an unknown way.
    """
    schemas: dict[int, Schema] = {}
    channels: dict[int, Channel] = {}
    counts: Counter[str] = Counter()
    extent = Extent(counts)
    for record in _records(stream):
        if isinstance(record, Schema):
            schemas[record.id] = record
        elif isinstance(record, Channel):
            channels[record.id] = record
        elif isinstance(record, Message):
            extent.add(channels[record.channel_id].topic, record.log_time)
    return Contents(tuple(_recorded(c, schemas) for c in channels.values()), extent)


def _records(stream: IO[bytes]) -> Iterator[McapRecord]:
    for record in StreamReader(stream, emit_chunks=True).records:
        if isinstance(record, Chunk):
            _check_compression(record.compression)
            yield from breakup_chunk(record)
        else:
            yield record


def _check_compression(name: str) -> None:
    if name not in _CHUNK_COMPRESSIONS:
        raise UnsupportedCompressionError(name)


def _recorded(channel: Channel, schemas: dict[int, Schema]) -> RecordedTopic:
    schema = schemas.get(channel.schema_id)
    return RecordedTopic(
        channel.topic,
        full_name(schema.name) if schema else '',
        channel.message_encoding,
        schema.data if schema else b'',
        schema.encoding if schema else '',
        channel.metadata.get('offered_qos_profiles', ''),
    )


def full_name(type_name: str) -> str:
    """Return a type's name as ROS 2 has it: some writers leave out the kind."""
    package, slash, name = type_name.partition('/')
    return type_name if not slash or '/' in name else f'{package}/msg/{name}'
