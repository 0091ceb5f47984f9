# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What is used of rclpy 7.1 beyond its public names, and ways round its faults.

docs/upstream.md tells each fault and when its way round may go. The timers, the largest of them,
have `hexapod_node.timers` to themselves.
"""

from collections.abc import Callable
from typing import Any

from rcl_interfaces.msg import ParameterType, SetParametersResult
from rcl_interfaces.srv import SetParameters
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.service import Service
from rclpy.task import Future

RCLError = rclpy_implementation.RCLError
"""What rclpy raises where its context or a handle is gone; it has no public name."""

_LAST_TYPE = ParameterType.PARAMETER_STRING_ARRAY


def answer_later(service: Service, answer: Callable[[Future, Any], None]) -> None:
    """Let a service whose callback returns a future answer when that is done.

    EventsExecutor hands what a callback returns straight to `send_response`.

    Args:
        service: that was created with such a callback.
        answer: is called with the future, which is done, and the request's header.
    """

    def send_when_done(done: Future, header: Any) -> None:
        done.add_done_callback(lambda future: answer(future, header))

    service.send_response = send_when_done  # type: ignore[method-assign, assignment]


def one_parameter_at_a_time(handler: Callable[..., Any]) -> Callable[..., Any]:
    """Return a handler of `set_parameters` that answers for each parameter, whatever it is.

    rclpy's own one raises at a type that it does not know, amid the list.
    """

    def answer(
        request: SetParameters.Request, response: SetParameters.Response
    ) -> SetParameters.Response:
        response.results = [_set(handler, parameter) for parameter in request.parameters]
        return response

    return answer


def _set(handler: Callable[..., Any], parameter: Any) -> SetParametersResult:
    if parameter.value.type > _LAST_TYPE:
        reason = f'type {parameter.value.type}: unknown, expected 0 to {_LAST_TYPE}'
        return SetParametersResult(successful=False, reason=f'{parameter.name}: {reason}')
    try:
        answer = handler(SetParameters.Request(parameters=[parameter]), SetParameters.Response())
    except Exception as error:
        return SetParametersResult(successful=False, reason=f'{parameter.name}: {error}')
    result: SetParametersResult = answer.results[0]
    return result
