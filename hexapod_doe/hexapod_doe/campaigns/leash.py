# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Runs a command that the kernel ends when the process that started it ends, however that ends.

Linux alone; elsewhere the command runs without a leash.
"""

import ctypes
import os
import signal
import sys

_PR_SET_PDEATHSIG = 1  # linux/prctl.h


def leashed(command: list[str]) -> list[str]:
    """Return the command line that runs a command on a leash held by this process."""
    return [sys.executable, '-m', __name__, str(os.getpid()), *command]


def main(arguments: list[str]) -> None:
    """Become the command, unless the holder of the leash is gone already."""
    holder, *command = arguments
    if sys.platform == 'linux':
        ctypes.CDLL(None, use_errno=True).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
    if os.getppid() == int(holder):
        os.execvp(command[0], command)


if __name__ == '__main__':
    main(sys.argv[1:])
