# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""flock(2), and one sentence where a file system has none."""

import fcntl
from pathlib import Path
from typing import IO, Any

from hexapod_doe.errors import LockingError


def lock(file: IO[Any], shared: bool = False) -> None:
    """Lock an open file for this process, alone or with others, without waiting.

    Raises:
        BlockingIOError: another process holds it.
        LockingError: the file lies where no file can be locked.
    """
    try:
        fcntl.flock(file, (fcntl.LOCK_SH if shared else fcntl.LOCK_EX) | fcntl.LOCK_NB)
    except BlockingIOError:
        raise
    except OSError as error:
        raise LockingError(
            f'{Path(file.name).parent}: its file system has no flock ({error.strerror}), expected '
            'a folder where files can be locked: a local disk, NFS 4, or Lustre mounted with '
            '-o flock'
        ) from error
