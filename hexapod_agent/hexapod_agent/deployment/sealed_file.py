# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Files that are written whole or not at all, and that tell when their content is damaged.

Such a file ends with a seal of 81 bytes: a mark, the SHA-256 of all that stands before it in
hexadecimal, and a line feed. Readers that begin at the front, or look for a ZIP archive's
directory from the end, pass over it.
"""

import hashlib
import os
from collections.abc import Callable
from enum import Enum
from pathlib import Path
from typing import IO

_MARK = b'\nhexapod-sha256: '
_SIZE = len(_MARK) + 64 + 1


class Seal(Enum):
    """What a file's seal says of its content."""

    WHOLE = 'whole'
    """It is what was written."""
    BROKEN = 'broken'
    """It is not what was written."""
    ABSENT = 'absent'
    """There is no seal: the end is lost, or there never was one."""


def write_sealed(path: Path, fill: Callable[[IO[bytes]], None]) -> None:
    """Write a file with a seal; a crash leaves the old file or the new one, never a part.

    Args:
        path: The file; its folder is made if there is none.
        fill: Writes the content.

    Raises:
        OSError: The disk refuses; the old file is still there.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_name(f'{path.name}.partial')
    try:
        with partial.open('w+b') as file:
            fill(file)
            file.seek(0)
            digest = hashlib.file_digest(file, 'sha256').hexdigest()
            file.seek(0, os.SEEK_END)
            file.write(_MARK + digest.encode() + b'\n')
            file.flush()
            os.fsync(file.fileno())
        partial.replace(path)
    except BaseException:
        partial.unlink(missing_ok=True)
        raise
    _sync_directory(path.parent)


def read_seal(path: Path) -> Seal:
    """Compare a file's content with its seal.

    Raises:
        OSError: The file cannot be read.
    """
    with path.open('rb') as file:
        content = max(file.seek(0, os.SEEK_END) - _SIZE, 0)
        file.seek(content)
        seal = file.read()
        if len(seal) != _SIZE or not seal.startswith(_MARK):
            return Seal.ABSENT
        file.seek(0)
        found = _digest(file, content)
    return Seal.WHOLE if seal == _MARK + found.encode() + b'\n' else Seal.BROKEN


def _digest(file: IO[bytes], size: int) -> str:
    """Return the SHA-256 of the next bytes of a file."""
    digest = hashlib.sha256()
    while size > 0:
        block = file.read(min(size, 1 << 20))
        if not block:
            break
        digest.update(block)
        size -= len(block)
    return digest.hexdigest()


def _sync_directory(directory: Path) -> None:
    """Make the renaming itself durable."""
    descriptor = os.open(directory, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
