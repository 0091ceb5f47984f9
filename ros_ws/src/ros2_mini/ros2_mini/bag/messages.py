# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The messages of a bag, in the order in which they were recorded."""

from collections.abc import Collection, Iterator
from dataclasses import dataclass

from mcap.exceptions import McapError
from mcap.reader import make_reader

from ros2_mini.bag.metadata import BagMetadata
from ros2_mini.errors import CommandError


@dataclass(frozen=True)
class RecordedMessage:
    """One message as it was on the wire."""

    topic: str
    time: int
    """When it was recorded [ns]."""
    data: bytes
    """CDR, with its encapsulation header."""


def read_messages(
    bag: BagMetadata, topics: Collection[str], start: int
) -> Iterator[RecordedMessage]:
    """Yield the messages of some topics from a time on.

    Args:
        bag: The bag.
        topics: Names of the topics.
        start: First time [ns].

    Raises:
        CommandError: If the bag is stored in another way than MCAP, or a file cannot be read.
    """
    if bag.storage != 'mcap':
        raise CommandError(
            f"bag '{bag.directory}' has the storage '{bag.storage}'; supported: mcap"
        )
    if bag.compression not in ('', 'NONE', 'none'):
        raise CommandError(
            f"bag '{bag.directory}' is compressed by '{bag.compression}'; supported: compression "
            'within MCAP'
        )
    for name in bag.files:
        path = bag.directory / name
        try:
            with path.open('rb') as stream:
                reader = make_reader(stream)
                for _, channel, message in reader.iter_messages(topics=topics, starting_at=start):
                    yield RecordedMessage(channel.topic, message.log_time, message.data)
        except (OSError, McapError) as error:
            raise CommandError(f"cannot read '{path}': {error or type(error).__name__}") from error
