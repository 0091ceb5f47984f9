# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Why tries of rows failed, as a file in the campaign's folder that outlives its manager."""

import csv
import fcntl
import os
from datetime import UTC, datetime
from pathlib import Path

FAILURES_FILE = 'failures.csv'
_COLUMNS = ('time', 'run_id', 'worker', 'reason')


class FailureLog:
    """The failures of those who are at a campaign now, on the disk at once."""

    def __init__(self, directory: Path) -> None:
        self._path = directory / FAILURES_FILE

    def clear(self) -> None:
        """Forget all: rows that failed earlier are tried again."""
        self._path.unlink(missing_ok=True)

    def add(self, run_id: str, worker: str, reason: str) -> None:
        """Note a failed try.

        Raises:
            OSError: the folder cannot be written.
        """
        with self._path.open('a', newline='', encoding='utf-8') as file:
            fcntl.flock(file, fcntl.LOCK_EX)  # several processes of a fleet may add
            file.seek(0, os.SEEK_END)
            writer = csv.writer(file)
            if not file.tell():
                writer.writerow(_COLUMNS)
            now = datetime.now(UTC).isoformat(timespec='microseconds')
            writer.writerow((now, run_id, worker, reason))


def read_failures(directory: Path, since: datetime | None = None) -> dict[str, list[str]]:
    """Return the reasons by run id; rows that were done later are among them.

    Args:
        directory: the campaign's folder.
        since: when the first one to read happened; all of them if None.
    """
    reasons: dict[str, list[str]] = {}
    try:
        file = (directory / FAILURES_FILE).open(newline='', encoding='utf-8')
    except FileNotFoundError:
        return reasons
    with file:
        for row in csv.DictReader(file):
            if since is not None and datetime.fromisoformat(row['time']) < since:
                continue
            reasons.setdefault(row['run_id'], []).append(row['reason'])
    return reasons
