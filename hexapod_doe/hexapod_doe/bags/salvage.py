# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Recovers what a recording held when its process, its disk or its machine failed.

MCAP is written in chunks that stand for themselves, so everything up to the last whole chunk can
be read. The result is a rosbag2 directory that any reader opens, but never a complete run.
"""

import itertools
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import IO, BinaryIO

from mcap.records import Channel, McapRecord, Message, Metadata, Schema
from mcap.stream_reader import StreamReader

from hexapod_doe.bags.bag_state import is_complete
from hexapod_doe.bags.bag_writer import BagWriter
from hexapod_doe.bags.opening import DAMAGE
from hexapod_doe.bags.rosbag2 import Topic, offered_qos, partial_path
from hexapod_doe.bags.run_bag import RUN_RECORD, SALVAGED
from hexapod_doe.errors import BagError, LockingError
from hexapod_doe.file_lock import lock

_GLANCES = 5
_GLANCE_S = 0.02


def salvage(bag: str | Path) -> Path:
    """Write what is whole in `<bag>.partial` to `<bag>.salvaged` and return that.

    The unfinished bag stays as it is.

    Raises:
        BagError: it is missing or still being written, or holds no whole chunk.
    """
    bag = Path(bag)
    copy = BagCopy(bag.with_name(f'{bag.name}.{SALVAGED}'))
    with _exclusive(bag) as stream:
        for record in whole_records(stream):
            copy.take(record)
    if copy.empty:
        raise BagError(f'bag {bag}: nothing to salvage, expected at least one whole chunk')
    return copy.close(copy.metadata | {'status': SALVAGED})


def set_aside(bag: str | Path, takeover: bool = False) -> Path | None:
    """Rename what is left of an earlier recording to `<bag>.cut_<n>`, so the run can be repeated.

    That is an unfinished `<bag>.partial`, or a `<bag>` that is damaged, incomplete, or a link that
    leads nowhere. A complete bag stays, and so does a directory that never was a bag of that name.

    Args:
        bag: directory that the finished bag would have had.
        takeover: also while it is being written; its writer then finds out and ends.

    Returns:
        The new name, or None where there is nothing to set aside.

    Raises:
        BagError: it is still being written.
    """
    bag = Path(bag)
    names = (bag.with_name(f'{bag.name}.cut_{n}') for n in itertools.count(1))
    aside = None
    if partial_path(bag).is_dir():
        if not takeover:
            _check_unlocked(bag)
        aside = partial_path(bag).rename(next(name for name in names if not name.exists()))
    lost = bag.is_symlink() and not bag.exists()
    if lost or (_file(bag, bag).is_file() and not is_complete(bag)):
        aside = bag.rename(next(name for name in names if not name.exists()))
    return aside


def whole_records(stream: IO[bytes]) -> Iterator[McapRecord]:
    """Yield the records of an MCAP file up to the first that is cut or fails its checksum."""
    records = StreamReader(stream, validate_crcs=True).records
    while True:
        try:
            record = next(records)
        except (StopIteration, *DAMAGE):
            return
        yield record


class BagCopy:
    """Puts the records of a bag into a new one, which is opened when the first message comes.

    Attributes:
        metadata: what the records said of their run so far.
    """

    def __init__(self, target: Path) -> None:
        self.metadata: dict[str, str] = {}
        self._target = target
        self._writer: BagWriter | None = None
        self._schemas: dict[int, Schema] = {}
        self._channels: dict[int, Channel] = {}

    @property
    def empty(self) -> bool:
        """Whether no message has come."""
        return self._writer is None

    def take(self, record: McapRecord) -> None:
        """Take over a record.

        Raises:
            BagError: there is something at the target already, or the disk refuses.
        """
        match record:
            case Metadata(name=name) if name == RUN_RECORD:
                self.metadata.update(record.metadata)
            case Schema():
                self._schemas[record.id] = record
            case Channel():
                self._channels[record.id] = record
            case Message():
                self._write(record)

    def close(self, metadata: Mapping[str, str]) -> Path:
        """Finish the new bag, with what it is to say of its run; return its directory.

        Raises:
            BagError: no message has come, or the disk refuses.
        """
        if self._writer is None:
            raise BagError(f'bag {self._target}: no message, expected some to write')
        for channel in self._channels.values():  # also those on which nothing was said
            self._writer.add_topic(topic_of(channel, self._schemas[channel.schema_id]))
        self._writer.metadata = dict(metadata)
        return self._writer.close()

    def _write(self, message: Message) -> None:
        if self._writer is None:
            self._writer = BagWriter(self._target, self.metadata)
        channel = self._channels[message.channel_id]
        if channel.topic not in self._writer.extent.counts:
            self._writer.add_topic(topic_of(channel, self._schemas[channel.schema_id]))
        self._writer.write(channel.topic, message.data, message.log_time, message.publish_time)


def topic_of(channel: Channel, schema: Schema) -> Topic:
    """Return the topic that an MCAP channel stands for."""
    return Topic(
        channel.topic,
        schema.name,
        offered_qos(channel.metadata.get('offered_qos_profiles', '')),
        definition=schema.data.decode(),
        type_hash=channel.metadata.get('topic_type_hash', ''),
    )


def _file(directory: Path, bag: Path) -> Path:
    return directory / f'{bag.name}_0.mcap'


def _check_unlocked(bag: Path) -> None:
    if _file(partial_path(bag), bag).is_file():
        with _exclusive(bag):
            pass


@contextmanager
def _exclusive(bag: Path) -> Iterator[BinaryIO]:
    path = _file(partial_path(bag), bag)
    try:
        with path.open('rb') as stream:
            _lock(stream)
            yield stream
    except FileNotFoundError as error:
        raise BagError(f'bag {bag}: no {path}, expected an unfinished recording') from error
    except BlockingIOError as error:
        raise BagError(f'bag {bag}: {path.parent} is still being written') from error
    except LockingError as error:
        raise BagError(f'bag {bag}: {error}') from error


def _lock(stream: BinaryIO) -> None:
    """Lock a file, or find it locked by more than the glance of somebody who watches."""
    for _ in range(_GLANCES):
        try:
            lock(stream)
        except BlockingIOError:
            time.sleep(_GLANCE_S)
        else:
            return
    lock(stream)
