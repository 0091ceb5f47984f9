# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Write messages as YAML, the way `ros2 topic echo` does."""

import array
import math
from typing import Any

import numpy as np
import yaml


def message_to_yaml(message: Any, length: int | None = None) -> str:
    """Return a message as a YAML document.

    Args:
        message: Any ROS message.
        length: Elements or characters shown of arrays and strings; all when None.
    """
    return yaml.dump(
        plain(message, length),
        allow_unicode=True,
        width=math.inf,
        default_flow_style=False,
        sort_keys=False,
    )


def plain(value: Any, length: int | None = None) -> Any:
    """Return a message, or the value of a field, in plain Python types.

    A message is a mapping of field names, in the order of its definition.

    Args:
        value: The message or value.
        length: See `message_to_yaml`.
    """
    if isinstance(value, bytes):
        return plain(value.decode('latin-1'), length)
    if isinstance(value, str):
        return value if length is None or len(value) <= length else value[:length] + '...'
    if isinstance(value, list | tuple | array.array | np.ndarray):
        items = [plain(item, length) for item in value[:length]]
        return [*items, '...'] if len(items) < len(value) else items
    if isinstance(value, np.number):
        return value.item()
    if isinstance(value, bool | int | float):
        return value
    names = value.get_fields_and_field_types()
    return {name: plain(getattr(value, name), length) for name in names}
