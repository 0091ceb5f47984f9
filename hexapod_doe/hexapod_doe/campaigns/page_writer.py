# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Keeps a campaign's page up to date from a thread of its own, which nobody waits for."""

from __future__ import annotations

import threading
from collections.abc import Callable
from pathlib import Path

from hexapod_doe.campaigns.folder import read_progress
from hexapod_doe.campaigns.page import write_page
from hexapod_doe.campaigns.progress import Progress

_PAUSE_S = 2.0


class PageWriter:
    """Writes the page again after something happened, at most every two seconds."""

    def __init__(self, directory: Path, report: Callable[[str], None]) -> None:
        """Begin to wait.

        Args:
            directory: the campaign's folder.
            report: takes one line where the page cannot be written; the campaign goes on.
        """
        self._directory = directory
        self._report = report
        self._progress: Progress | None = None
        self._failed = False
        self._news = threading.Event()
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._follow, name='page', daemon=True)
        self._thread.start()

    def refresh(self) -> None:
        """Say that something happened, and return at once."""
        self._news.set()

    def close(self) -> None:
        """Write the page as it stays, and end."""
        self._closing.set()
        self._news.set()
        self._thread.join()

    def _follow(self) -> None:
        while not self._closing.is_set():
            self._news.wait()
            self._news.clear()
            self._write()
            self._closing.wait(_PAUSE_S)
        self._write()

    def _write(self) -> None:
        known = self._progress.runs if self._progress else None
        try:
            self._progress = read_progress(self._directory, known)
            write_page(self._progress, self._directory)
        except (OSError, ValueError) as error:  # a page is no reason to stop a campaign
            if not self._failed:
                self._report(f'page of {self._directory} not written: {error}')
            self._failed = True
        else:
            self._failed = False
