# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Waits in a coroutine until something becomes true."""

from __future__ import annotations

import time
from collections.abc import Callable

from rclpy.node import Node

from hexapod_node.coroutines import sleep

_POLL_S = 0.005


async def until_true(node: Node, condition: Callable[[], bool], timeout_s: float) -> bool:
    """Wait on the steady clock, also while simulated time stands still.

    Returns:
        Whether the condition came true within the time.
    """
    deadline = time.monotonic() + timeout_s
    while not condition():
        if time.monotonic() > deadline:
            return False
        await sleep(node, _POLL_S)
    return True
