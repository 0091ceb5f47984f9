# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Opens a rosbag2 directory with MCAP storage, checks that it is whole, and reads its messages."""

from __future__ import annotations

import os
import struct
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, BinaryIO, NamedTuple

import yaml
from mcap.exceptions import McapError
from mcap.reader import McapReader, SeekingReader
from mcap.writer import MCAP0_MAGIC
from mcap_ros2.decoder import DecoderFactory
from zstandard import ZstdError

from hexapod_doe.bags.rosbag2 import METADATA_FILE, ROOT_KEY, offered_qos, partial_path
from hexapod_doe.bags.run_bag import RUN_RECORD
from hexapod_doe.errors import BagError

_YAML_LOADER = getattr(yaml, 'CSafeLoader', yaml.SafeLoader)
DAMAGE = (
    McapError, ZstdError, struct.error, ValueError, OSError,
    LookupError, OverflowError, MemoryError,
)  # fmt: skip
"""What reading a damaged MCAP file raises: checksums are ValueErrors, a damaged index leads to
channels that do not exist (LookupError), or to lengths beyond all memory (the last two)."""


class RawMessage(NamedTuple):
    """One message as it went over the wire."""

    topic: str
    time_ns: int
    data: bytes


class BagFile:
    """A closed bag, its sums checked against its metadata.yaml.

    Attributes:
        path: the directory.
        types: message type by topic.
        counts: number of messages by topic.
        qos: what the publishers of each topic offered.
        start_ns: time of the first message.
        files: the MCAP files, in order.
    """

    def __init__(self, path: str | Path) -> None:
        """Read metadata.yaml and the summary of each MCAP file.

        Raises:
            BagError: missing, unfinished, cut, or not a rosbag2 directory with MCAP storage.
        """
        self.path = Path(path)
        information = self._information()
        try:
            listed = {
                entry['topic_metadata']['name']: entry
                for entry in information['topics_with_message_count']
            }
            self.types = {name: e['topic_metadata']['type'] for name, e in listed.items()}
            self.qos = {
                name: offered_qos(e['topic_metadata'].get('offered_qos_profiles', ()))
                for name, e in listed.items()
            }
            self.counts = {name: int(e['message_count']) for name, e in listed.items()}
            self.start_ns = int(information['starting_time']['nanoseconds_since_epoch'])
            self.files = [self.path / name for name in information['relative_file_paths']]
        except (KeyError, TypeError, AttributeError) as error:
            raise self._foreign(f'{METADATA_FILE} lacks {error}') from error
        self._check_counts()

    def run_metadata(self) -> dict[str, str]:
        """Return the metadata of the run; what was written last holds.

        Raises:
            BagError: there is none, so the bag is not of a run.
        """
        metadata = self.metadata()
        if 'run_id' not in metadata:
            raise BagError(
                f'bag {self.path}: foreign, no metadata record {RUN_RECORD} with a run_id, '
                'expected the bag of a run'
            )
        return metadata

    def metadata(self) -> dict[str, str]:
        """Return what the bag says of its run; nothing where it is not of a run."""
        metadata: dict[str, str] = {}
        for file in self.files:
            with self._reading(file) as reader:
                for record in reader.iter_metadata():
                    if record.name == RUN_RECORD:
                        metadata.update(record.metadata)
        return metadata

    def topic(self, name: str) -> str:
        """Return the one topic that has the name, or whose name ends with it.

        Raises:
            BagError: none, or several.
        """
        if name in self.types:
            return name
        found = [topic for topic in self.types if topic.endswith('/' + name)]
        if len(found) != 1:
            have = ', '.join(sorted(self.types)) or 'none'
            raise BagError(f"bag {self.path}: topic '{name}' expected, topics are {have}")
        return found[0]

    def topic_of_type(self, type_name: str) -> str:
        """Return the one topic of a type.

        Raises:
            BagError: none, or several.
        """
        found = [topic for topic, name in self.types.items() if name == type_name]
        if len(found) != 1:
            raise BagError(
                f'bag {self.path}: {len(found)} topics of type {type_name}, expected one'
            )
        return found[0]

    def messages(
        self, topics: Collection[str] | None = None, start_ns: int | None = None
    ) -> Iterator[RawMessage]:
        """Yield the messages of some topics, or of all, from a time on, in the order of time.

        Raises:
            BagError: the bag is damaged; where all of a topic is read, also if one is missing.
        """
        read = 0
        for file in self.files:
            with self._reading(file) as reader:
                for _, channel, message in reader.iter_messages(topics, starting_at=start_ns):
                    read += 1
                    yield RawMessage(channel.topic, message.log_time, message.data)
        if start_ns is None:
            self._check_read(read, self.counts if topics is None else topics)

    def decoded(self, topic: str) -> Iterator[tuple[int, Any]]:
        """Yield (time [ns], message) of one topic, decoded by the definitions in the bag.

        Raises:
            BagError: the bag is damaged, or a message is missing.
        """
        read = 0
        for file in self.files:
            with self._reading(file) as reader:
                for _, _, message, decoded in reader.iter_decoded_messages([topic]):
                    read += 1
                    yield message.log_time, decoded
        self._check_read(read, [topic])

    def _check_read(self, read: int, topics: Collection[str]) -> None:
        """Raise unless every message was read: a chunk of zeros goes by without an error."""
        expected = sum(self.counts[topic] for topic in topics)
        if read != expected:
            raise BagError(
                f'bag {self.path}: {read} of {expected} messages can be read, expected all: '
                'a file of it is damaged'
            )

    def _information(self) -> dict[str, Any]:
        if not self.path.is_dir():
            partial = partial_path(self.path)
            reason = (
                f'the recording was not finished, {partial} is what there is'
                if partial.is_dir()
                else 'no such directory'
            )
            raise BagError(f'bag {self.path}: {reason}, expected a closed rosbag2 directory')
        path = self.path / METADATA_FILE
        try:
            information = yaml.load(path.read_text(encoding='utf-8'), Loader=_YAML_LOADER)
            information = information[ROOT_KEY]
            storage = information['storage_identifier']
        except FileNotFoundError as error:
            raise self._foreign(f'no {METADATA_FILE}') from error
        except (yaml.YAMLError, UnicodeDecodeError, KeyError, TypeError) as error:
            raise self._foreign(f'{METADATA_FILE} is not that of rosbag2') from error
        if storage != 'mcap':
            raise self._foreign(f"storage '{storage}'")
        return dict(information)

    def _check_counts(self) -> None:
        total = 0
        for file in self.files:
            with self._reading(file) as reader:
                summary = reader.get_summary()
                if summary is None or summary.statistics is None:
                    return  # without sums there is nothing to compare
                total += summary.statistics.message_count
        if total != sum(self.counts.values()):
            raise BagError(
                f'bag {self.path}: holds {total} messages, expected '
                f'{sum(self.counts.values())} as its {METADATA_FILE} says'
            )

    @contextmanager
    def _reading(self, file: Path) -> Iterator[McapReader]:
        try:
            with file.open('rb') as stream:
                _check_ends(stream)
                yield SeekingReader(
                    stream, validate_crcs=True, decoder_factories=[DecoderFactory()]
                )
        except FileNotFoundError as error:
            raise BagError(f'bag {self.path}: {file.name} is missing') from error
        except DAMAGE as error:
            raise BagError(
                f'bag {self.path}: {file.name} is damaged ({error or type(error).__name__}), '
                'expected a whole MCAP file'
            ) from error

    def _foreign(self, reason: str) -> BagError:
        return BagError(
            f'bag {self.path}: {reason}, expected a rosbag2 directory with MCAP storage'
        )


def _check_ends(stream: BinaryIO) -> None:
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
