# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Frees the shared memory that killed participants of Fast DDS leave on this host.

A participant has a segment `fastrtps_<16 digits>` of about 0.5 MB, and holds flock(2) on the file
of the same name with `_el` as long as it lives. Names are random, so nobody takes a segment over.
Its ports, `fastrtps_port<number>`, are smaller and left alone: their numbers are few, the next
participant takes them over, and a live sender may have one open.
"""

import fcntl
import re
import sys
import time
from contextlib import suppress
from pathlib import Path

_FOLDER = Path('/dev/shm')
_LOCK = re.compile(r'(fastrtps_[0-9a-f]{16})_el')
_YOUNG_S = 5.0  # a participant makes the file, and then locks it


def free_abandoned(folder: Path = _FOLDER) -> None:
    """Free what nobody owns, and tell on standard error if there was any."""
    sizes = [
        _free(folder / match[1], lock)
        for lock in _files(folder)
        if (match := _LOCK.fullmatch(lock.name)) and _abandoned(lock)
    ]
    if freed := sum(sizes):
        print(
            f'{folder}: freed {freed / 1e6:.1f} MB of shared memory that killed nodes had left',
            file=sys.stderr,
        )


def _files(folder: Path) -> list[Path]:
    try:
        return list(folder.iterdir())
    except OSError:  # no such system, or not for us
        return []


def _abandoned(lock: Path) -> bool:
    """Whether no participant holds a lock, nor is about to."""
    try:
        with lock.open('rb') as file:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return time.time() - lock.stat().st_mtime > _YOUNG_S
    except OSError:  # held; gone; another user's
        return False


def _free(segment: Path, lock: Path) -> int:
    """Remove a segment and its lock; return the bytes that this has freed."""
    size = 0
    with suppress(OSError):  # another process was quicker; another user's
        size = segment.stat().st_size
        segment.unlink()
    with suppress(OSError):
        lock.unlink()
        return size
    return 0
