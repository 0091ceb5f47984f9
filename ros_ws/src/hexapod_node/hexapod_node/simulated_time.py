# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Calls back whenever a node's simulated time moves."""

from __future__ import annotations

from collections.abc import Callable

from rclpy.clock import JumpThreshold
from rclpy.duration import Duration
from rclpy.node import Node

from hexapod_node.timers import call_soon

_ANY_MOVE = JumpThreshold(
    min_forward=Duration(nanoseconds=1), min_backward=Duration(nanoseconds=-1)
)


class SimulatedTime:
    """The steps of /clock, as a node with `use_sim_time` hears them.

    Steps that come while the last one has yet to be served are one.
    """

    def __init__(self, node: Node, callback: Callable[[], object]) -> None:
        """Begin to listen.

        Args:
            node: whose clock it is, and whose executor calls.
            callback: called after each step.
        """
        self._node = node
        self._callback = callback
        self._posted = self._cancelled = False
        self._jumps = node.get_clock().create_jump_callback(_ANY_MOVE, post_callback=self._on_jump)

    def cancel(self) -> None:
        """Listen no more."""
        self._cancelled = True
        self._jumps.unregister()

    def _on_jump(self, _: object) -> None:
        """Leave the middleware's call, which every clock of the process waits for."""
        if not self._posted:
            self._posted = True
            call_soon(self._node, self._serve)

    def _serve(self) -> None:
        self._posted = False
        if not self._cancelled:
            self._callback()
