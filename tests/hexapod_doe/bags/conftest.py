# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Bags as other programs write them, for what no recorder of ours would do."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import pytest
import yaml
from hexapod_doe.bags.rosbag2 import Extent, Topic, information
from mcap.writer import CompressionType, IndexType, Writer

STRING = 'std_msgs/msg/String'
HELLO = b'\0\1\0\0\6\0\0\0hello\0'


@dataclass(frozen=True)
class Recorded:
    """One channel of a foreign file with its messages."""

    name: str = '/chatter'
    type_name: str = STRING
    definition: bytes = b'string data'
    language: str = 'ros2msg'
    encoding: str = 'cdr'
    messages: Sequence[tuple[int, bytes]] = ((5, HELLO),)
    type_hash: str = ''


def write_file(path: Path, channels: Sequence[Recorded], indexed: bool = True) -> None:
    """Write an MCAP file; without an index it has no summary at all."""
    options = (
        {}
        if indexed
        else {
            'index_types': IndexType.NONE,
            'repeat_channels': False,
            'repeat_schemas': False,
            'use_statistics': False,
            'use_summary_offsets': False,
        }
    )
    with path.open('wb') as stream:
        writer = Writer(stream, compression=CompressionType.NONE, **options)
        writer.start(profile='ros2')
        for channel in channels:
            schema = writer.register_schema(
                channel.type_name, channel.language, channel.definition
            )
            number = writer.register_channel(channel.name, channel.encoding, schema)
            for time_ns, data in channel.messages:
                writer.add_message(number, time_ns, data, time_ns)
        writer.finish()


@pytest.fixture
def foreign(tmp_path: Path) -> Callable[..., Path]:
    """Write a bag of channels, and say otherwise in its metadata where `changes` do."""

    def write(*channels: Recorded, indexed: bool = True, **changes: object) -> Path:
        bag = tmp_path / 'foreign'
        bag.mkdir()
        write_file(bag / 'foreign_0.mcap', channels, indexed)
        extent = Extent({channel.name: 0 for channel in channels})
        for channel in channels:
            for time_ns, _ in channel.messages:
                extent.add(channel.name, time_ns)
        topics = [
            Topic(channel.name, channel.type_name, type_hash=channel.type_hash)
            for channel in {channel.name: channel for channel in channels}.values()
        ]
        said = information('foreign_0.mcap', topics, extent) | changes
        (bag / 'metadata.yaml').write_text(yaml.safe_dump({'rosbag2_bagfile_information': said}))
        return bag

    return write
