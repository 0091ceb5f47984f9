# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Coroutines that are resumed by the event that they wait for.

rclpy's own tasks poll: a coroutine that awaits a future is called again and again until it is
done, which keeps a core busy. Here the future's done-callback resumes it, so waiting costs nothing
and the coroutine goes on inside the very callback that brought the message.
"""

from __future__ import annotations

import types
from collections.abc import Coroutine, Generator
from typing import Any

from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.task import Future

from hexapod_node.timers import call_later, call_soon

STEADY = Clock(clock_type=ClockType.STEADY_TIME)


@types.coroutine
def until(future: Future) -> Generator[Future, None, Any]:
    """Wait for a future and return its result, or raise its exception."""
    if not future.done():
        yield future
    return future.result()


def start(coroutine: Coroutine[Future, None, Any]) -> Future:
    """Run a coroutine that waits with `until`; return the future of what it returns or raises."""
    done = Future()

    def resume(_: Future | None = None) -> None:
        try:
            awaited = coroutine.send(None)
        except StopIteration as stop:
            done.set_result(stop.value)
        except Exception as error:
            done.set_exception(error)
        else:
            awaited.add_done_callback(resume)

    resume()
    return done


async def pause(node: Node) -> None:
    """Let the executor serve what else is due."""
    turn = Future()
    call_soon(node, lambda: turn.set_result(None))
    await until(turn)


async def sleep(node: Node, seconds: float) -> None:
    """Wait without blocking the executor, on a clock that goes on when simulated time stands."""
    done = Future()
    timer = call_later(node, seconds, lambda: done.set_result(None))
    try:
        await until(done)
    finally:
        timer.cancel()
