# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Writes rosbag2 directories of which none is ever taken for whole before it is.

All writing happens in `<bag>.partial`, which holds an advisory lock while its writer lives. Only
`close` gives the directory its name, after everything has reached the disk and was read back.
"""

import os
from collections.abc import Mapping
from dataclasses import replace
from io import BufferedWriter
from pathlib import Path
from types import TracebackType
from typing import Self

from mcap.well_known import MessageEncoding, Profile, SchemaEncoding
from mcap.writer import CompressionType, Writer

from hexapod_doe.bags import rosbag2
from hexapod_doe.bags.bag_file import BagFile
from hexapod_doe.bags.rosbag2 import METADATA_FILE, ROOT_KEY, Topic, partial_path
from hexapod_doe.bags.run_bag import DIGEST, RUN_RECORD
from hexapod_doe.bags.schema import definition, type_hash
from hexapod_doe.bags.verify import Digest, check_messages
from hexapod_doe.errors import BagError, LockingError
from hexapod_doe.file_lock import lock

CHUNK_BYTES = 1 << 20


class BagWriter:
    """One bag while it is written.

    As a context manager it closes the bag at the end of the block, and leaves it partial when the
    block raises.
    """

    def __init__(
        self, bag: Path, metadata: Mapping[str, str], chunk_bytes: int = CHUNK_BYTES
    ) -> None:
        """Open `<bag>.partial`.

        Args:
            bag: directory that the closed bag will have.
            metadata: of the run; stored now, and once more with its updates at the end.
            chunk_bytes: uncompressed size at which a chunk is written out.

        Raises:
            BagError: there is something at either place already, or it cannot be written.
        """
        self.bag = bag
        self.partial = partial_path(bag)
        self.metadata = dict(metadata)
        self.extent = rosbag2.Extent({})
        self._topics: dict[str, Topic] = {}
        self._schemas: dict[str, int] = {}
        self._channels: dict[str, int] = {}
        self._digest = Digest()
        self._broken = False
        if bag.exists():
            raise BagError(f'bag {bag}: exists already, expected a new directory')
        self._file = self._open()
        self._writer = Writer(
            self._file,
            chunk_size=chunk_bytes,
            compression=CompressionType.ZSTD,
            enable_data_crcs=True,
        )
        try:
            self._writer.start(profile=Profile.ROS2)
            self._writer.add_metadata(RUN_RECORD, self.metadata)
            self._file.flush()
        except OSError as error:
            raise self._failure(error) from error

    def add_topic(self, topic: Topic) -> None:
        """List a topic; adding it again changes nothing.

        Raises:
            BagError: it was listed with another type, or its type is not installed.
        """
        had = self._topics.get(topic.name)
        if had is not None:
            if had.type_name != topic.type_name:
                raise BagError(
                    f'bag {self.bag}: topic {topic.name} is {topic.type_name}, '
                    f'expected {had.type_name} as before'
                )
            return
        topic = replace(
            topic,
            definition=topic.definition or definition(topic.type_name),
            type_hash=topic.type_hash or type_hash(topic.type_name),
        )
        if topic.type_name not in self._schemas:
            self._schemas[topic.type_name] = self._writer.register_schema(
                topic.type_name, SchemaEncoding.ROS2, topic.definition.encode()
            )
        self._channels[topic.name] = self._writer.register_channel(
            topic.name,
            MessageEncoding.CDR,
            self._schemas[topic.type_name],
            {
                'offered_qos_profiles': rosbag2.qos_text(topic.qos),
                'topic_type_hash': topic.type_hash,
            },
        )
        self._topics[topic.name] = topic
        self.extent.counts[topic.name] = 0

    def write(self, topic: str, data: bytes, log_ns: int, publish_ns: int | None = None) -> None:
        """Write one serialised message of a topic that was added.

        Raises:
            BagError: the disk refuses; what was written before stays.
        """
        publish_ns = log_ns if publish_ns is None else publish_ns
        self._check_usable()
        try:
            self._writer.add_message(self._channels[topic], log_ns, data, publish_ns)
        except OSError as error:
            raise self._failure(error) from error
        self.extent.add(topic, log_ns)
        self._digest.add(topic, data, log_ns)

    def flush(self) -> None:
        """End the chunk and hand it to the system: what came so far survives this process.

        Raises:
            BagError: the disk refuses, or another writer has taken the bag over.
        """
        self._check_usable()
        self._check_owned()
        try:
            self._writer.flush()
            self._file.flush()
        except OSError as error:
            raise self._failure(error) from error

    def secure(self) -> None:
        """Wait until the disk has what came so far: it survives the machine.

        Raises:
            BagError: the disk refuses, or another writer has taken the bag over.
        """
        self.flush()
        try:
            os.fsync(self._file.fileno())
            _sync_directory(self.partial)
            _sync_directory(self.partial.parent)
        except OSError as error:
            raise self._failure(error) from error

    def close(self) -> Path:
        """Finish the bag, read it back from the disk, give it its name and return that.

        Raises:
            BagError: the disk refuses or does not hold what was written, or another writer has
                taken the bag over. The bag keeps its unfinished name.
        """
        self._finish()
        check_messages(BagFile(self.partial), self.metadata[DIGEST])
        os.rename(self.partial, self.bag)
        _sync_directory(self.bag.parent)
        return self.bag

    def abandon(self) -> Path:
        """Finish the files but keep the unfinished name, which is returned."""
        if not self._broken:
            self._finish()
        return self.partial

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if kind is None:
            self.close()
        else:
            self.abandon()

    def _open(self) -> BufferedWriter:
        try:
            self.partial.mkdir(parents=True)
            file = (self.partial / f'{self.bag.name}_0.mcap').open('xb')
        except FileExistsError as error:
            if not self.partial.exists():  # something above it is a file
                raise self._refusal(error) from error
            raise BagError(
                f'bag {self.bag}: {self.partial} is being written, or was left by a recording '
                'that was cut; salvage it or set it aside first'
            ) from error
        except OSError as error:
            raise self._refusal(error) from error
        try:
            lock(file)
        except LockingError as error:
            file.close()
            Path(file.name).unlink()  # nothing is in it, and it would look like a cut recording
            self.partial.rmdir()
            raise BagError(f'bag {self.bag}: {error}') from error
        return file

    def _finish(self) -> None:
        self._check_usable()
        self._check_owned()
        self.metadata[DIGEST] = self._digest.hexdigest(self._topics)
        information = rosbag2.information(
            Path(self._file.name).name, self._topics.values(), self.extent
        )
        try:
            self._writer.add_metadata(RUN_RECORD, self.metadata)
            # rosbag2 repeats metadata.yaml here, for readers that are given the file alone.
            self._writer.add_metadata(
                'rosbag2', {'serialized_metadata': rosbag2.to_yaml(information)}
            )
            self._writer.finish()
            self._file.flush()
            os.fsync(self._file.fileno())
            self._file.close()
            _write_synced(self.partial / METADATA_FILE, rosbag2.to_yaml({ROOT_KEY: information}))
            _sync_directory(self.partial)
        except OSError as error:
            raise self._failure(error) from error

    def _check_usable(self) -> None:
        if self._broken or self._file.closed:
            state = 'an earlier write failed' if self._broken else 'it is closed'
            raise BagError(f'bag {self.bag}: cannot write, {state}')

    def _check_owned(self) -> None:
        """Make sure that `<bag>.partial` still is the directory of this writer's file.

        It no longer is once a later recording of the run has set it aside.
        """
        try:
            there = os.stat(self._file.name)
        except FileNotFoundError:
            there = None
        if there is None or not os.path.samestat(there, os.fstat(self._file.fileno())):
            self._broken = True
            self._file.raw.close()
            raise BagError(
                f'bag {self.bag}: another recorder has taken the run over, this one ends'
            )

    def _refusal(self, error: OSError) -> BagError:
        return BagError(f'bag {self.bag}: cannot write: {error.strerror}: {error.filename}')

    def _failure(self, error: OSError) -> BagError:
        self._broken = True
        # Closing the buffer would try once more to write what it holds.
        self._file.raw.close()
        return BagError(
            f'bag {self.bag}: cannot write: {error.strerror}; '
            f'the {self.extent.messages} messages recorded so far stay in {self.partial}, '
            'as far as their chunks were complete'
        )


def _write_synced(path: Path, text: str) -> None:
    with path.open('x', encoding='utf-8') as file:
        file.write(text)
        file.flush()
        os.fsync(file.fileno())


def _sync_directory(path: Path) -> None:
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
