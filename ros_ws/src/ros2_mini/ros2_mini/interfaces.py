# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Find message and service types by name."""

import importlib
from typing import Any

from ros2_mini.errors import CommandError

KINDS = {'msg': 'message', 'srv': 'service'}


def load_type(name: str, kind: str) -> Any:
    """Return the Python class of an interface.

    Args:
        name: Such as `std_msgs/msg/String`, or `std_msgs/String` for short.
        kind: A key of KINDS.

    Raises:
        CommandError: If there is no such interface of that kind.
    """
    parts = name.split('/')
    if len(parts) == 2:
        parts.insert(1, kind)
    if len(parts) != 3 or parts[1] != kind:
        raise CommandError(
            f"The passed {KINDS[kind]} type is invalid: '{name}', expected <package>/{kind}/<name>"
        )
    package, _, class_name = parts
    try:
        return getattr(importlib.import_module(f'{package}.{kind}'), class_name)
    except (AttributeError, ModuleNotFoundError) as error:
        raise CommandError(
            f"The passed {KINDS[kind]} type is invalid: '{name}' is not installed"
        ) from error
