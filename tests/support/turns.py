# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Tests in several processes at once, and those alone that judge how long something takes."""

from __future__ import annotations

import fcntl
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest


class Turns:
    """What the worker processes of one run share: a room for many, or for one alone.

    Whoever wants in passes a door first and holds it while waiting, so that a test that wants
    the room alone gets it as soon as those inside are done.
    """

    def __init__(self, folder: Path) -> None:
        """Begin outside.

        Args:
            folder: of this run, made where it is not there.
        """
        folder.mkdir(exist_ok=True)
        self._door, self._room = folder / 'door', folder / 'room'

    @contextmanager
    def taken(self, alone: bool) -> Iterator[None]:
        """Hold the room, alone or beside others."""
        with self._door.open('a') as door, self._room.open('a') as room:
            fcntl.flock(door, fcntl.LOCK_EX)
            fcntl.flock(room, fcntl.LOCK_EX if alone else fcntl.LOCK_SH)
            fcntl.flock(door, fcntl.LOCK_UN)
            try:
                yield
            finally:
                fcntl.flock(room, fcntl.LOCK_UN)  # a forked child may hold the file for longer

    @pytest.hookimpl(wrapper=True, tryfirst=True)  # around the timeout, which does not wait
    def pytest_runtest_protocol(self, item: pytest.Item) -> Iterator[None]:
        """Have a test wait for its turn."""
        with self.taken(item.get_closest_marker('alone') is not None):
            return (yield)
