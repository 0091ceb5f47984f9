# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Callbacks that learn the number of a message among those of its publisher."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any


class NumberedCallback:
    """A subscription's callback for message and publication sequence number.

    rclpy tells by a callback's signature whether it wants the message's info. EventsExecutor of
    rclpy 7.1 then passes message and info as one tuple, where the other executors pass two
    arguments; `tests/graph/test_message_info.py` says when that is over.
    """

    def __init__(self, callback: Callable[[Any, int | None], None]) -> None:
        """Wrap.

        Args:
            callback: takes the message and its number, None where the middleware has none.
        """
        self._callback = callback
        parameters = [
            inspect.Parameter(name, inspect.Parameter.POSITIONAL_ONLY)
            for name in ('message', 'info')
        ]
        self.__signature__ = inspect.Signature(parameters)

    def __call__(self, *given: Any) -> None:
        """Take what an executor passes."""
        message, info = given if len(given) == 2 else given[0]
        self._callback(message, info.get('publication_sequence_number'))
