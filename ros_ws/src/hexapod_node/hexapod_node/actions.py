# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Actions under EventsExecutor: execution by coroutine, and handlers that may fail."""

from typing import Any

from rclpy import action
from rclpy.action.server import ServerGoalHandle
from rclpy.node import Node

from hexapod_node import progress
from hexapod_node.coroutines import start
from hexapod_node.handlers import count_failure


class CoroutineActionServer(action.ActionServer):
    """An action server whose execute callback is a coroutine that waits with `until`."""

    def __init__(
        self, node: Node, action_type: Any, name: str, execute: Any, **options: Any
    ) -> None:
        self._counted = (node, name)
        super().__init__(node, action_type, name, execute, **options)

    async def execute(self, taken_data: Any) -> None:
        """Serve what came; what cannot be served is counted, and its client waits in vain."""
        progress.served()
        try:
            await super().execute(taken_data)
        except Exception as error:
            count_failure(*self._counted, error)

    def notify_execute(self, goal_handle: ServerGoalHandle, execute_callback: Any = None) -> None:
        """Start the coroutine; the base class gets a callback that has its result at once."""
        done = start((execute_callback or self._execute_callback)(goal_handle))
        finish = super().notify_execute
        done.add_done_callback(lambda future: finish(goal_handle, lambda _: future.result()))


class ActionClient(action.ActionClient):
    """An action client whose callbacks may fail at what a server sends."""

    def __init__(self, node: Node, action_type: Any, action_name: str) -> None:
        self._counted = (node, action_name)
        super().__init__(node, action_type, action_name)

    async def execute(self, taken_data: Any) -> None:
        """Serve what came, feedback among it."""
        progress.served()
        try:
            await super().execute(taken_data)
        except Exception as error:
            count_failure(*self._counted, error)
