# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Reads a closed bag from end to end, and holds its messages to a count and a fingerprint."""

import hashlib
import struct
import zlib
from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import IO

import yaml
from mcap.records import DataEnd, McapRecord, Metadata
from mcap.stream_reader import StreamReader
from mcap.writer import MCAP0_MAGIC

from hexapod_doe.bags.bag_file import BagFile
from hexapod_doe.bags.metadata import YAML_LOADER
from hexapod_doe.bags.rosbag2 import METADATA_FILE, ROOT_KEY
from hexapod_doe.bags.run_bag import DIGEST, evaluation_of
from hexapod_doe.errors import BagError

_MODULUS = 1 << 256


class Digest:
    """The fingerprint while messages come, in whatever order.

    SHA-256 of every message with its time, added up modulo 2^256 per topic: an incremental hash
    of a multiset (Bellare and Micciancio, EUROCRYPT 1997). It tells damage, not forgery.
    """

    def __init__(self) -> None:
        self._sums: dict[str, int] = {}

    def add(self, topic: str, data: bytes, time_ns: int) -> None:
        """Take in one message."""
        one = hashlib.sha256(struct.pack('<Q', time_ns))
        one.update(data)
        number = int.from_bytes(one.digest(), 'little')
        self._sums[topic] = (self._sums.get(topic, 0) + number) % _MODULUS

    def hexdigest(self, topics: Iterable[str]) -> str:
        """Return the fingerprint of a bag that lists these topics, those without messages too."""
        namespace = _namespace(topics)
        sums = {topic.removeprefix(namespace): value for topic, value in self._sums.items()}
        total = hashlib.sha256()
        for topic, value in sorted(sums.items()):
            total.update(struct.pack('<Q', len(topic.encode())))
            total.update(topic.encode())
            total.update(value.to_bytes(32, 'little'))
        return total.hexdigest()


def digest(bag: str | Path) -> str:
    """Return the SHA-256, in hexadecimal, of every message, its topic and its time.

    Neither the order of messages counts, nor the namespace of the worker that the run was on, nor
    metadata.

    Raises:
        hexapod_doe.errors.BagError: the bag cannot be read to its end.
    """
    file = BagFile(bag)
    total = Digest()
    for message in file.messages():
        total.add(message.topic, message.data, message.time_ns)
    return total.hexdigest(file.types)


def _namespace(topics: Iterable[str]) -> str:
    """Return the start, up to a slash, that all topics share."""
    parts = [topic.split('/')[:-1] for topic in topics]
    shared: list[str] = []
    for column in zip(*parts, strict=False):
        if len(set(column)) > 1:
            break
        shared.append(column[0])
    return '/'.join([*shared, ''])


_FOOTER = struct.Struct('<QQI')
"""Where the summary starts, where its offsets start, and the sum over all up to here."""
_SUM_BYTES = 4


def verify(bag: str | Path) -> None:
    """Check the bag of a run: its messages, their digest, and that each episode is there once.

    A bag of an earlier version, which does not state its digest, passes without that check.

    Raises:
        BagError: the bag cannot be read to its end, or is not what it says.
    """
    file = BagFile(bag)
    metadata = file.run_metadata()
    check_messages(file, metadata.get(DIGEST))
    _check_episodes(file, [file.result_topic()], int(metadata['episodes']))
    _check_episodes(file, file.evaluation_topics(), evaluation_of(metadata))
    check_bytes(file, metadata.get(DIGEST))


def check_messages(file: BagFile, digest: str | None) -> None:
    """Read every message and compare their number per topic, and their digest.

    Raises:
        BagError: the bag cannot be read to its end, or is not what it says.
    """
    counts: Counter[str] = Counter()
    found = Digest()
    for message in file.messages():
        counts[message.topic] += 1
        found.add(message.topic, message.data, message.time_ns)
    for topic, expected in file.counts.items():
        if counts[topic] != expected:
            raise BagError(
                f'bag {file.path}: {counts[topic]} messages of {topic}, expected {expected}'
            )
    read = found.hexdigest(file.types)
    if digest is not None and read != digest:
        raise BagError(f'bag {file.path}: digest {read}, expected {digest} as recorded')


def check_bytes(file: BagFile, digest: str | None) -> None:
    """Make sure that every byte of a bag is as it was written, without decoding a message.

    The files' sums cover all of them, and they repeat metadata.yaml. A file without a sum over its
    data, of an earlier version or another maker, is read message by message against its digest.

    Raises:
        BagError: a byte is not.
    """
    for path in file.files:
        with file.opened(path) as stream:
            records = list(_outer_records(stream))
        ends = [record for record in records if isinstance(record, DataEnd)]
        if not ends:
            raise BagError(f'bag {path}: no end of the data, expected one; it is damaged')
        if any(end.data_section_crc for end in ends):
            _check_copy(file, records)
        elif digest is not None:
            check_messages(file, digest)
            return


def _outer_records(stream: IO[bytes]) -> Iterator[McapRecord]:
    """Yield what stands outside of chunks, once the sums of a file are found right."""
    _check_summary(stream.read())
    stream.seek(0)
    for record in StreamReader(stream, emit_chunks=True, validate_crcs=True).records:
        if isinstance(record, (Metadata, DataEnd)):
            yield record


def _check_summary(content: bytes) -> None:
    """Compare the sum over a file's summary and footer, which no reader does.

    Raises:
        ValueError: it is another one.
    """
    end = len(content) - len(MCAP0_MAGIC)
    start, _, expected = _FOOTER.unpack_from(content, end - _FOOTER.size)
    found = zlib.crc32(content[start : end - _SUM_BYTES])
    if expected and found != expected:
        raise ValueError(f'sum of its summary {found}, expected {expected}')


def _check_copy(file: BagFile, records: Iterable[McapRecord]) -> None:
    """Compare metadata.yaml with its copy in the bag's file."""
    copies = [
        record.metadata.get('serialized_metadata', '')
        for record in records
        if isinstance(record, Metadata) and record.name == 'rosbag2'
    ]
    path = file.path / METADATA_FILE
    if not copies or not path.is_file():
        return
    text, copy = path.read_text(encoding='utf-8'), copies[-1]
    if yaml.load(text, YAML_LOADER)[ROOT_KEY] != yaml.load(copy, YAML_LOADER):
        raise BagError(
            f'bag {file.path}: {METADATA_FILE} is not what the recorder wrote, expected the copy '
            f'of it in {file.files[0].name}'
        )


def _check_episodes(file: BagFile, topics: Iterable[str], episodes: int) -> None:
    numbers = sorted(result.episode for topic in topics for _, result in file.decoded(topic))
    if numbers != list(range(episodes)):
        odd = next((n for n, found in enumerate(numbers) if n != found), len(numbers))
        raise BagError(
            f'bag {file.path}: {len(numbers)} episode results, the first fault at episode {odd}; '
            f'expected each of {episodes} once'
        )
