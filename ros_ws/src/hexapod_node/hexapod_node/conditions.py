# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Waits in a coroutine until something becomes true."""

from __future__ import annotations

import time
from collections.abc import Callable

from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.task import Future

from hexapod_node.coroutines import until

_POLL_S = 0.005


async def until_true(node: Node, condition: Callable[[], bool], timeout_s: float) -> bool:
    """Wait on the steady clock, also while simulated time stands still.

    Returns:
        Whether the condition came true within the time.
    """
    deadline = time.monotonic() + timeout_s
    steady = Clock(clock_type=ClockType.STEADY_TIME)
    while not condition():
        if time.monotonic() > deadline:
            return False
        tick = Future()
        timer = node.create_timer(
            _POLL_S, lambda tick=tick: tick.done() or tick.set_result(None), clock=steady
        )
        try:
            await until(tick)
        finally:
            node.destroy_timer(timer)
    return True
