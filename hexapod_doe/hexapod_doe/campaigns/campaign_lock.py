# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Locks of a campaign's folder and of its rows, held by the operating system.

A lock ends with the process that holds it, however that ends. What the lock file says of its
holder is for the error message alone.
"""

import json
import os
import socket
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path
from typing import TextIO

from hexapod_doe.errors import CampaignError, LockingError
from hexapod_doe.file_lock import lock

LOCK_FILE = 'campaign.lock'
ROW_SUFFIX = '.lock'


@contextmanager
def campaign_lock(directory: Path, shared: bool = False) -> Iterator[None]:
    """Hold a campaign's folder: a manager alone, or any number of processes that take single rows.

    Raises:
        CampaignError: somebody else holds it, or the folder cannot be written or locked.
    """
    with _lock(directory / LOCK_FILE, shared, f'campaign {directory}'):
        yield


@contextmanager
def row_lock(bag: Path) -> Iterator[None]:
    """Hold one row, by the directory that its bag will have.

    Raises:
        CampaignError: another process is at it, or the folder cannot be written or locked.
    """
    with _lock(bag.with_name(bag.name + ROW_SUFFIX), False, f'run {bag.name}'):
        yield


@contextmanager
def _lock(path: Path, shared: bool, what: str) -> Iterator[None]:
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        file = path.open('a+', encoding='utf-8')
    except OSError as error:
        raise CampaignError(
            f'{what}: cannot write: {error.strerror}: {error.filename}, expected a folder that '
            'this process may write'
        ) from error
    with file:
        try:
            lock(file, shared)
        except BlockingIOError as error:
            raise CampaignError(
                f'{what}: {_holder(file)} is at it, expected to be alone; end it first'
            ) from error
        except LockingError as error:
            raise CampaignError(f'{what}: {error}') from error
        _sign(file, what)
        yield
        # The file stays: to remove it would let two processes lock two files of its name.


def _sign(file: TextIO, what: str) -> None:
    """Write who holds the lock, for those who come later."""
    holder = {
        'host': socket.gethostname(),
        'pid': os.getpid(),
        'command': ' '.join(sys.argv),
        'since': datetime.now(UTC).isoformat(timespec='seconds'),
    }
    try:
        file.truncate(0)
        file.write(json.dumps(holder) + '\n')
        file.flush()
    except OSError as error:
        raise CampaignError(f'{what}: cannot write: {error.strerror}: {file.name}') from error


def _holder(file: TextIO) -> str:
    file.seek(0)
    try:
        holder = json.loads(file.read())
        return (
            f'process {holder["pid"]} on {holder["host"]} ({holder["command"]}, since '
            f'{holder["since"]})'
        )
    except (ValueError, KeyError):  # it has the lock, and has yet to sign
        return 'another process'
