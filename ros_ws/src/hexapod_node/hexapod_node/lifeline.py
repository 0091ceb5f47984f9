# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Ends a process with the one that started it.

A manager keeps the writing end of a pipe whose reading end is the process's standard input, so
that any number of processes may lie between the two. A launch file sets a variable, and the kernel
watches the launch: `ros2 launch` of ROS 2 ends on SIGTERM and leaves its nodes running.
"""

import ctypes
import os
import signal
import sys
import threading
import time

LIFELINE = 'HEXAPOD_LIFELINE'
"""Environment variable that says that standard input is such a pipe."""
LAUNCHED = 'HEXAPOD_LAUNCHED'
"""Environment variable that says that the parent is the launch that this process belongs to."""
_GRACE_S = 10.0
_PR_SET_PDEATHSIG = 1  # linux/prctl.h


def follow() -> None:
    """End this process when its lifeline is cut, if it has one."""
    if os.environ.pop(LIFELINE, ''):
        threading.Thread(target=_wait, name='lifeline', daemon=True).start()


def follow_launch() -> None:
    """End this process, as SIGTERM does, when the launch that started it ends; Linux alone."""
    if os.environ.pop(LAUNCHED, '') and sys.platform == 'linux':
        ctypes.CDLL(None, use_errno=True).prctl(_PR_SET_PDEATHSIG, signal.SIGTERM)


def _wait() -> None:
    while os.read(0, 1):
        pass
    os.kill(os.getpid(), signal.SIGTERM)
    time.sleep(_GRACE_S)
    os.kill(os.getpid(), signal.SIGKILL)
