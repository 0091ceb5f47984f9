# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Write messages as YAML or CSV, the way `ros2 topic echo` does."""

import array
import math
from typing import Any

import numpy as np
import yaml
from rosidl_parser import definition


def message_to_yaml(
    message: Any,
    *,
    truncate_length: int | None = None,
    no_arr: bool = False,
    no_str: bool = False,
) -> str:
    """Return a message as a YAML document.

    Args:
        message: Any ROS message.
        truncate_length: Elements or characters shown of arrays and strings; all when None.
        no_arr: Show type and length of arrays in place of their elements.
        no_str: Show the length of strings in place of their characters.
    """
    return yaml.dump(
        message_to_dict(message, truncate_length=truncate_length, no_arr=no_arr, no_str=no_str),
        allow_unicode=True,
        width=math.inf,
        default_flow_style=False,
        sort_keys=False,
    )


def message_to_dict(message: Any, **options: Any) -> dict[str, Any]:
    """Return a message as a mapping of field names, in the order of its definition.

    Args:
        message: Any ROS message.
        options: `truncate_length`, `no_arr` and `no_str` of `message_to_yaml`.
    """
    fields = zip(message.get_fields_and_field_types(), message.SLOT_TYPES, strict=True)
    return {name: plain(getattr(message, name), kind, **options) for name, kind in fields}


def plain(
    value: Any,
    kind: Any = None,
    *,
    truncate_length: int | None = None,
    no_arr: bool = False,
    no_str: bool = False,
) -> Any:
    """Return the value of a field in plain Python types, abridged as `message_to_yaml` says.

    Args:
        value: The value.
        kind: Its `rosidl_parser` type, named where an array is left out; an array is never left
            out when this is None.
        truncate_length: See `message_to_yaml`.
        no_arr: See `message_to_yaml`.
        no_str: See `message_to_yaml`.
    """
    options: dict[str, Any] = {
        'truncate_length': truncate_length,
        'no_arr': no_arr,
        'no_str': no_str,
    }
    if isinstance(value, bytes):
        return _cut(value.decode('latin-1'), truncate_length)
    if isinstance(value, str):
        return f'<string length: <{len(value)}>>' if no_str else _cut(value, truncate_length)
    if isinstance(value, list | tuple | array.array | np.ndarray):
        if no_arr and kind is not None:
            return _array_summary(value, kind)
        shown = list(value[:truncate_length])
        items = [plain(item, **options) for item in shown]
        return [*items, '...'] if len(shown) < len(value) else items
    if isinstance(value, np.number):
        return value.item()
    if isinstance(value, bool | int | float):
        return value
    return message_to_dict(value, **options)


def message_to_csv(message: Any, **options: Any) -> str:
    """Return all values of a message, those of nested messages too, with commas between.

    Args:
        message: Any ROS message.
        options: `truncate_length`, `no_arr` and `no_str` of `message_to_yaml`.
    """
    return _joined(message_to_dict(message, **options))


def _joined(value: Any) -> str:
    """Return values with commas between; an empty array is an empty column, unless it is first."""
    if not isinstance(value, dict | list):
        return str(value)
    text = ''
    for item in value.values() if isinstance(value, dict) else value:
        text += (',' if text else '') + _joined(item)
    return text


def _cut(text: str, length: int | None) -> str:
    return text if length is None or len(text) <= length else text[:length] + '...'


def _array_summary(value: Any, kind: Any) -> str:
    name = _type_name(kind.value_type)
    if isinstance(kind, definition.Array):
        return f'<array type: {name}[{kind.size}]>'
    if isinstance(kind, definition.BoundedSequence):
        return f'<sequence type: {name}[{kind.maximum_size}], length: {len(value)}>'
    return f'<sequence type: {name}, length: {len(value)}>'


def _type_name(kind: Any) -> str:
    if isinstance(kind, definition.NamespacedType):
        return '/'.join(kind.namespaced_name())
    if isinstance(kind, definition.AbstractString):
        return 'string'
    if isinstance(kind, definition.AbstractWString):
        return 'wstring'
    return kind.typename
