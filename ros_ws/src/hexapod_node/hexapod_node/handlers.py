# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Lets no message and no request of any peer end a node: what a handler raises is an answer.

Under rclpy an exception of a handler leaves the executor and ends the process. Here a service
answers that it failed and why, a message is dropped, and either is counted by the name of its
endpoint, which the diagnostics show.
"""

import functools
import traceback
from collections import Counter
from collections.abc import Callable
from typing import Any

from rcl_interfaces.srv import SetParameters
from rclpy.node import Node

from hexapod_node import progress, upstream

_THROTTLE_S = 2.0
_LONGEST_TEXT = 500


def count_failure(node: Node, endpoint: str, error: BaseException) -> None:
    """Count a failure of a handler and say what it was."""
    failures(node)[endpoint] += 1
    where = traceback.extract_tb(error.__traceback__)[-1:]
    place = f' ({where[0].filename}:{where[0].lineno})' if where else ''
    if node.context.ok():
        node.get_logger().error(
            f'{endpoint}: {failure_text(error)}{place}', throttle_duration_sec=_THROTTLE_S
        )


def failures(node: Node) -> Counter[str]:
    """Return how often handlers of a node failed, by the name of their endpoint."""
    counts: Counter[str] = vars(node).setdefault('_hexapod_failures', Counter())
    return counts


def failure_text(error: BaseException) -> str:
    """Return what an error says, with its class where it says little by itself."""
    text = str(error)[:_LONGEST_TEXT]
    return text if isinstance(error, OSError | ValueError) else f'{type(error).__name__}: {text}'


def guarded(node: Node, endpoint: str, handler: Callable[..., Any]) -> Callable[..., Any]:
    """Return a handler of messages that drops and counts those at which it fails."""

    @functools.wraps(handler)  # rclpy looks at the signature
    def take(*message: Any) -> Any:
        progress.served()
        try:
            return handler(*message)
        except Exception as error:
            if not node.context.ok():  # a signal came amid it
                raise
            count_failure(node, endpoint, error)

    return take


def answering(
    node: Node, kind: type, name: str, handler: Callable[..., Any]
) -> Callable[..., Any]:
    """Return a handler of requests that answers where it fails, as `failed` says."""
    if kind is SetParameters:
        handler = upstream.one_parameter_at_a_time(handler)

    def answer(request: Any, response: Any) -> Any:
        progress.served()
        try:
            return handler(request, response)
        except Exception as error:
            if not node.context.ok():
                raise
            return failed(node, kind, name, error)

    return answer


def failed(node: Node, kind: Any, name: str, error: BaseException) -> Any:
    """Count a failure and return the response that tells of it, as far as the type can tell."""
    count_failure(node, name, error)
    response = kind.Response()
    outcome = getattr(response, 'result', response)
    for field, value in (
        ('success', False),
        ('successful', False),
        ('message', failure_text(error)),
        ('reason', failure_text(error)),
    ):
        if hasattr(outcome, field):
            setattr(outcome, field, value)
    return response
