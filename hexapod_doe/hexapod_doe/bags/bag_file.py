# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Opens a bag with MCAP storage, checks that it is whole, and reads its messages."""

from collections import Counter
from collections.abc import Callable, Collection, Iterator
from contextlib import AbstractContextManager
from functools import cached_property
from pathlib import Path
from typing import IO, Any, NamedTuple

from hexapod_doe.bags.decoding import Decoders, decompressed
from hexapod_doe.bags.location import CONVERT, located
from hexapod_doe.bags.mcap_file import (
    Contents,
    RecordedTopic,
    gone_through,
    summed_up,
)
from hexapod_doe.bags.metadata import BagMetadata, bare_metadata, read_metadata
from hexapod_doe.bags.opening import FileOpener
from hexapod_doe.bags.rosbag2 import METADATA_FILE, OfferedQos
from hexapod_doe.bags.run_bag import EPISODE_RESULT, RUN_RECORD, is_evaluation
from hexapod_doe.errors import BagError


class RawMessage(NamedTuple):
    """One message as it went over the wire."""

    topic: str
    time_ns: int
    data: bytes


class BagFile:
    """A closed bag, its sums checked against its metadata.yaml.

    Attributes:
        path: the directory, or the one MCAP file.
        about: what it says of itself.
        types: message type by topic; the first one, where a topic has several.
        counts: number of messages by topic.
        qos: what the publishers of each topic offered.
        start_ns: time of the first message.
        files: the MCAP files, in order.
    """

    def __init__(self, path: str | Path) -> None:
        """Read metadata.yaml and the summary of each MCAP file.

        Args:
            path: a rosbag2 directory, or one MCAP file, which is then read by itself; `~` is the
                home directory.

        Raises:
            BagError: missing, unfinished, cut, or not a bag with MCAP storage.
        """
        self.path = located(path)
        self._open = FileOpener(self.path)
        if self.path.is_dir():
            self.about = read_metadata(self.path)
            self._check_storage()
            self.files = [self.path / name for name in self.about.files]
            self._sums = [self._sum_up(file) for file in self.files]
        else:
            self.files = [self.path]
            contents = self._sum_up(self.path) or self._go_through(self.path)
            self._sums = [contents]
            self.about = bare_metadata(self.path, contents)
        self.types: dict[str, str] = {}
        self.qos: dict[str, tuple[OfferedQos, ...]] = {}
        self.counts: Counter[str] = Counter()
        for topic in self.about.topics:
            self.types.setdefault(topic.name, topic.type_name)
            self.qos[topic.name] = (*self.qos.get(topic.name, ()), *topic.qos)
            self.counts[topic.name] += topic.count
        self.start_ns = self.about.start_ns
        self._check_counts()

    def opened(self, file: Path) -> AbstractContextManager[IO[bytes]]:
        """Open one of the bag's files for its bytes.

        Raises:
            BagError: it is missing or damaged, now or while it is read.
        """
        return self._open.plain(file)

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
            with self._open.reading(file) as reader:
                for record in reader.iter_metadata():
                    if record.name == RUN_RECORD:
                        metadata.update(record.metadata)
        return metadata

    @cached_property
    def recorded(self) -> dict[str, tuple[RecordedTopic, ...]]:
        """How each topic was recorded: once, unless its channels differ in type or definition.

        A file without a summary is read to its end for it.

        Raises:
            BagError: such a file is damaged.
        """
        found: dict[str, dict[tuple[str, ...], RecordedTopic]] = {}
        for file, sums in zip(self.files, self._sums, strict=True):
            for topic in (sums or self._go_through(file)).topics:
                kinds = found.setdefault(topic.name, {})
                kinds.setdefault((topic.type_name, str(topic.definition)), topic)
        return {name: tuple(kinds.values()) for name, kinds in found.items()}

    def types_of(self, topic: str) -> list[str]:
        """Return every type of which messages of a topic are listed or recorded, sorted."""
        listed = {each.type_name for each in self.about.topics if each.name == topic}
        return sorted(listed | {each.type_name for each in self.recorded.get(topic, ())})

    def found(self, name: str) -> list[str]:
        """Return the topics that a name may mean: its own, or those that end with it."""
        if name in self.types:
            return [name]
        return sorted(topic for topic in self.types if topic.endswith('/' + name))

    def topic(self, name: str, kind: str = '') -> str:
        """Return the one topic that has the name, or whose name ends with it.

        Args:
            name: whole, or its end.
            kind: message type that it must have; '' for any.

        Raises:
            BagError: none, or several, or one of another type.
        """
        found = self.found(name)
        if len(found) > 1:
            raise BagError(
                f'bag {self.path}: {several(name, found)}; choose one by its whole name'
            )
        if not found:
            have = ', '.join(sorted(self.types)) or 'none'
            raise BagError(f"bag {self.path}: topic '{name}' expected, topics are {have}")
        if kind and self.types[found[0]] != kind:
            raise BagError(
                f'bag {self.path}: {found[0]} is of type {self.types[found[0]]}, expected {kind}'
            )
        return found[0]

    def result_topic(self) -> str:
        """Return the topic of the results of a run's own episodes.

        Raises:
            BagError: none, or several.
        """
        return self.topic_of_type(EPISODE_RESULT, is_evaluation)

    def evaluation_topics(self) -> list[str]:
        """Return the topic of the results of a run's evaluation, if it has one."""
        own = [topic for topic, name in self.types.items() if name == EPISODE_RESULT]
        return [topic for topic in own if is_evaluation(topic)]

    def topic_of_type(self, type_name: str, but: Callable[[str], bool] = lambda _: False) -> str:
        """Return the one topic of a type, but for those that do not count.

        Raises:
            BagError: none, or several.
        """
        found = [t for t, name in self.types.items() if name == type_name and not but(t)]
        if len(found) != 1:
            names = f' ({", ".join(sorted(found))})' if found else ''
            raise BagError(
                f'bag {self.path}: {len(found)} topics of type {type_name}{names}, expected one'
            )
        return found[0]

    def messages(
        self, topics: Collection[str] | None = None, start_ns: int | None = None
    ) -> Iterator[RawMessage]:
        """Yield the messages of some topics, or of all, from a time on, in the order of time.

        Messages that rosbag2 compressed one by one come decompressed.

        Raises:
            BagError: the bag is damaged; where all of a topic is read, also if one is missing.
        """
        read = 0
        for file in self.files:
            with self._open.reading(file) as reader:
                for _, channel, message in reader.iter_messages(topics, starting_at=start_ns):
                    read += 1
                    yield RawMessage(channel.topic, message.log_time, decompressed(message.data))
        if start_ns is None:
            self._check_read(read, self.counts if topics is None else topics)

    def decoded(self, topic: str) -> Iterator[tuple[int, Any]]:
        """Yield (time [ns], message) of one topic, decoded by the definitions in the bag.

        Raises:
            BagError: the bag is damaged, a message is missing, or one cannot be decoded.
        """
        kinds = self.types_of(topic)
        if len(kinds) > 1:
            raise BagError(
                f'bag {self.path}: {topic} has the types {" and ".join(kinds)}, expected one'
            )
        read = 0
        for file in self.files:
            decoders = Decoders(self.path)
            with self._open.reading(file) as reader:
                for schema, channel, message in reader.iter_messages([topic]):
                    read += 1
                    yield message.log_time, decoders.decode(schema, channel, message)
        self._check_read(read, [topic])

    def _check_read(self, read: int, topics: Collection[str]) -> None:
        """Raise unless every message was read: a chunk of zeros goes by without an error."""
        expected = sum(self.counts[topic] for topic in topics)
        if read != expected:
            raise BagError(
                f'bag {self.path}: {read} of {expected} messages can be read, expected all: '
                'a file of it is damaged'
            )

    def _check_storage(self) -> None:
        about: BagMetadata = self.about
        if about.storage != 'mcap':
            raise BagError(
                f"bag {self.path}: storage '{about.storage}', expected MCAP; cure: {CONVERT}"
            )
        if about.compression not in ('', 'zstd'):
            raise BagError(
                f"bag {self.path}: compressed with '{about.compression}', expected zstd; "
                'cure: `ros2 bag convert` it'
            )

    def _check_counts(self) -> None:
        if None in self._sums:
            return  # without sums there is nothing to compare
        total = sum(sums.extent.messages for sums in self._sums if sums)
        if total != sum(self.counts.values()):
            raise BagError(
                f'bag {self.path}: holds {total} messages, expected '
                f'{sum(self.counts.values())} as its {METADATA_FILE} says'
            )

    def _sum_up(self, file: Path) -> Contents | None:
        with self._open.reading(file) as reader:
            return summed_up(reader)

    def _go_through(self, file: Path) -> Contents:
        with self._open.plain(file) as stream:
            return gone_through(stream)


def several(name: str, found: Collection[str]) -> str:
    """Say that a topic's name may mean several."""
    times = 'twice' if len(found) == 2 else f'{len(found)} times'
    return f"topic '{name}' is there {times}: {', '.join(found)}"
