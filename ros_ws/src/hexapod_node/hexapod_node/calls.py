# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Service calls that are awaited, with one clear error where nobody answers."""

from __future__ import annotations

from typing import Any

from rclpy.client import Client
from rclpy.node import Node
from rclpy.task import Future

from hexapod_node.conditions import until_true
from hexapod_node.coroutines import until
from hexapod_node.timers import call_later


class ServiceUnavailableError(TimeoutError):
    """A service has no server, or its server did not answer in time."""


async def call(node: Node, client: Client, request: Any, timeout_s: float) -> Any:
    """Wait for the server, call it and return its response.

    Raises:
        ServiceUnavailableError: no server appeared, or none answered, within the time.
    """
    if not await until_true(node, client.service_is_ready, timeout_s):
        raise ServiceUnavailableError(
            f'service {client.service_name}: no server within {timeout_s:g} s, expected a '
            f'running node that offers it'
        )
    answer = client.call_async(request)
    timer = call_later(node, timeout_s, lambda: _give_up(client, answer, timeout_s))
    try:
        return await until(answer)
    finally:
        timer.cancel()


def _give_up(client: Client, answer: Future, timeout_s: float) -> None:
    if not answer.done():
        answer.set_exception(
            ServiceUnavailableError(
                f'service {client.service_name}: no answer within {timeout_s:g} s'
            )
        )
