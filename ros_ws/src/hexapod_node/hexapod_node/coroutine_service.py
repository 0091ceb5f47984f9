# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Services whose answer takes a while, without holding up the executor meanwhile.

EventsExecutor hands the return value of a service's callback straight to `send_response`, so a
coroutine function cannot be the callback of a service. Here the callback returns a future, and
sending waits for it; any executor serves it.
"""

from __future__ import annotations

from collections.abc import Callable, Coroutine
from typing import Any

from rclpy.node import Node
from rclpy.service import Service
from rclpy.task import Future

from hexapod_node.coroutines import start
from hexapod_node.handlers import failed

Handler = Callable[[Any, Any], Coroutine[Future, None, Any]]


def create_coroutine_service(node: Node, kind: type, name: str, handler: Handler) -> Service:
    """Offer a service whose handler is a coroutine that waits with `coroutines.until`.

    Args:
        node: that offers it.
        kind: service type.
        name: of the service.
        handler: takes request and response, returns the response to send.
    """
    service = node.create_service(
        kind, name, lambda request, response: start(handler(request, response))
    )
    send = service.send_response

    def send_when_done(done: Future, header: Any) -> None:
        done.add_done_callback(lambda future: answer(future, header))

    def answer(future: Future, header: Any) -> None:
        error = future.exception()
        send(failed(node, kind, name, error) if error else future.result(), header)

    service.send_response = send_when_done  # type: ignore[method-assign, assignment]
    return service
