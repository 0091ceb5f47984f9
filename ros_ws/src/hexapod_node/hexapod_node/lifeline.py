# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Ends a process with the one that started it, through any number of processes between them.

The starter keeps the writing end of a pipe whose reading end is the process's standard input.
"""

from __future__ import annotations

import os
import signal
import threading
import time

LIFELINE = 'HEXAPOD_LIFELINE'
"""Environment variable that says that standard input is such a pipe."""
_GRACE_S = 10.0


def follow() -> None:
    """End this process when its lifeline is cut, if it has one."""
    if os.environ.pop(LIFELINE, ''):
        threading.Thread(target=_wait, name='lifeline', daemon=True).start()


def _wait() -> None:
    while os.read(0, 1):
        pass
    os.kill(os.getpid(), signal.SIGTERM)
    time.sleep(_GRACE_S)
    os.kill(os.getpid(), signal.SIGKILL)
