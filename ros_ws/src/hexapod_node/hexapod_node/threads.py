# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Work that takes long, in a thread of its own, awaited by a coroutine of the node."""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import Future
from typing import TypeVar

from rclpy.node import Node
from rclpy.task import Future as Turn

from hexapod_node.coroutines import until
from hexapod_node.timers import call_soon

Result = TypeVar('Result')


async def in_thread(node: Node, work: Callable[[], Result]) -> Result:
    """Return what some work returns, or raise what it raises; the node serves others meanwhile.

    The thread does not keep the process alive: work is cut when the process ends.
    """
    done: Future[Result] = Future()
    turn = Turn()
    done.add_done_callback(lambda _: call_soon(node, lambda: turn.set_result(None)))
    threading.Thread(target=_run, args=(work, done), daemon=True).start()
    await until(turn)
    return done.result()


def _run(work: Callable[[], Result], done: Future[Result]) -> None:
    try:
        done.set_result(work())
    except BaseException as error:
        done.set_exception(error)
