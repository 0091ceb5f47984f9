# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""SIGINT and SIGTERM ask a process to end, however often they come, and interrupt nothing.

rclpy's own handlers end the context and wake the executor, then call the handlers of here. A
terminal and `ros2 launch` both send SIGINT: by Python's own handler the second one would interrupt
the end of the process, as the first one would any callback.
"""

import os
import signal
from types import FrameType
from typing import Any

STOPPING = (signal.SIGINT, signal.SIGTERM)

_requested = False


Handlers = dict[int, Any]
"""What `signal.signal` takes, by number."""


def end_at_once() -> None:
    """Let a signal end the process with status 0: nothing has begun that would have to end."""
    for number in STOPPING:
        signal.signal(number, _end)


def take_over() -> Handlers:
    """Note the signals from here on; return the handlers until now.

    To be called before `rclpy.init`.
    """
    return {number: signal.signal(number, _note) for number in STOPPING}


def give_back(handlers: Handlers) -> None:
    """Leave the signals to these handlers again, unless one has come: then the process ends."""
    if requested():
        ignore()
        return
    for number, handler in handlers.items():
        signal.signal(number, handler)


def requested() -> bool:
    """Whether one has come."""
    return _requested


def ignore() -> None:
    """Let nothing more interrupt the end of the process, the interpreter's own end included."""
    for number in STOPPING:
        signal.signal(number, signal.SIG_IGN)


def _note(_number: int, _frame: FrameType | None) -> None:
    global _requested
    _requested = True


def _end(_number: int, _frame: FrameType | None) -> None:
    # An exception would be lost where the signal arrives in a finaliser or a weak reference's
    # callback, and imports are full of them.
    os._exit(0)
