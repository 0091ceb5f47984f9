# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Ways round faults of rclpy 7.1; docs/upstream.md tells each one and when it may go.

The timers, the largest of them, have `hexapod_node.timers` to themselves.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rcl_interfaces.msg import ParameterType, SetParametersResult
from rcl_interfaces.srv import SetParameters

_LAST_TYPE = ParameterType.PARAMETER_STRING_ARRAY


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
