# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Opens the files of one bag, and turns what goes wrong with them into errors of the bag."""

import struct
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO

from mcap.exceptions import McapError, UnsupportedCompressionError
from mcap.reader import McapReader, SeekingReader
from zstandard import ZstdError

from hexapod_doe.bags.decoding import short
from hexapod_doe.bags.mcap_file import PACKED_SUFFIX, check_ends, unpacked
from hexapod_doe.bags.rosbag2 import METADATA_FILE
from hexapod_doe.errors import BagError

DAMAGE = (
    McapError, ZstdError, struct.error, ValueError, OSError,
    LookupError, OverflowError, MemoryError,
)  # fmt: skip
"""What reading a damaged MCAP file raises: checksums are ValueErrors, a damaged index leads to
channels that do not exist (LookupError), or to lengths beyond all memory (the last two)."""


class FileOpener:
    """Opens files of one bag; those that are compressed as a whole are unpacked once."""

    def __init__(self, bag: Path) -> None:
        """Begin with none.

        Args:
            bag: named in errors.
        """
        self._bag = bag
        self._unpacked: dict[Path, IO[bytes]] = {}

    @contextmanager
    def reading(self, file: Path) -> Iterator[McapReader]:
        """Open a whole MCAP file.

        Raises:
            BagError: it is missing, cut short or damaged, now or while it is read.
        """
        with self.plain(file) as stream:
            check_ends(stream)
            yield SeekingReader(stream, validate_crcs=True)

    @contextmanager
    def plain(self, file: Path) -> Iterator[IO[bytes]]:
        """Open a file of the bag for its bytes.

        Raises:
            BagError: it is missing or damaged, now or while it is read.
        """
        try:
            with self._unpacked_path(file).open('rb') as stream:
                yield stream
        except BagError:
            raise
        except FileNotFoundError as error:
            raise BagError(
                f'bag {self._bag}: {file.name} is missing, expected all that {METADATA_FILE} '
                'lists; cure: copy it, or give one of the others by itself'
            ) from error
        except UnsupportedCompressionError as error:
            raise BagError(
                f'bag {self._bag}: {file.name}: {error}, expected chunks in lz4, zstd or plain'
            ) from error
        except DAMAGE as error:
            raise BagError(
                f'bag {self._bag}: {file.name} is damaged ({short(error)}), '
                'expected a whole MCAP file'
            ) from error

    def _unpacked_path(self, file: Path) -> Path:
        """Return a file as MCAP; one that is compressed as a whole is unpacked once."""
        if file.suffix != PACKED_SUFFIX:
            return file
        if file not in self._unpacked:
            self._unpacked[file] = unpacked(file)
        return Path(self._unpacked[file].name)
