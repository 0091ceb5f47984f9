# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Fill messages from the YAML of a command line, field by field and with checks.

The original converts what it can and lets the rest pass; here a value that does not fit its field
is an error that names the field, because rclpy itself checks nothing by default.
"""

import argparse
import array
import importlib
import sys
from collections.abc import Callable
from functools import partial
from typing import Any, TypeAlias

import numpy as np
import yaml
from rosidl_parser import definition

from ros2_mini.errors import CommandError

StampSetter: TypeAlias = Callable[[Any], None]

_INTEGERS = {
    f'{sign}int{bits}': (-(2 ** (bits - 1)), 2 ** (bits - 1)) if not sign else (0, 2**bits)
    for sign in ('', 'u')
    for bits in (8, 16, 32, 64)
} | {'char': (0, 256), 'wchar': (0, 65536)}
_REALS = ('float', 'double', 'long double')


def read_values(text: str) -> dict[str, Any]:
    """Return the fields that a YAML text gives.

    Raises:
        CommandError: If the text is no YAML, or no mapping of field names.
    """
    try:
        values = yaml.safe_load(text)
    except yaml.YAMLError as error:
        raise CommandError(f"'{text}' is no YAML: {' '.join(str(error).split())}") from error
    if values is None:
        return {}
    if not isinstance(values, dict):
        raise CommandError(
            f"The passed value needs to be a dictionary in YAML format, but is '{text}'"
        )
    return values


def fill_message(message: Any, values: dict[str, Any]) -> list[StampSetter]:
    """Set fields of a message.

    Args:
        message: The message to change.
        values: Values by field name; nested messages are mappings. `now` for a time and `auto` for
            a header stand for the time of publishing.

    Returns:
        Functions that set those times, each given a `builtin_interfaces` Time.

    Raises:
        CommandError: If a field does not exist or a value does not fit it.
    """
    stamps: list[StampSetter] = []
    try:
        _fill(message, values, '', stamps)
    except _FieldError as error:
        raise CommandError(f'Failed to populate field: {error}') from error
    return stamps


class _FieldError(ValueError):
    def __init__(self, path: str, value: object, expected: str) -> None:
        super().__init__(f"'{path}' is {value!r}, expected {expected}")


def _fill(message: Any, values: Any, path: str, stamps: list[StampSetter]) -> None:
    name_of = type(message).__name__
    if not isinstance(values, dict):
        raise _FieldError(path or name_of, values, f'the fields of a {name_of}')
    kinds = dict(zip(message.get_fields_and_field_types(), message.SLOT_TYPES, strict=True))
    for name, value in values.items():
        where = f'{path}.{name}' if path else str(name)
        if name not in kinds:
            known = ', '.join(kinds) or 'none'
            raise _FieldError(where, value, f'a field of {name_of}, which has: {known}')
        kind = kinds[name]
        if value == 'now' and _named(kind) == 'builtin_interfaces/msg/Time':
            stamps.append(partial(setattr, message, name))
        elif value == 'auto' and _named(kind) == 'std_msgs/msg/Header':
            stamps.append(partial(setattr, getattr(message, name), 'stamp'))
        else:
            setattr(message, name, _convert(value, kind, where, stamps))


def _named(kind: Any) -> str | None:
    is_message = isinstance(kind, definition.NamespacedType)
    return '/'.join(kind.namespaced_name()) if is_message else None


def _convert(value: Any, kind: Any, path: str, stamps: list[StampSetter]) -> Any:
    """Return `value` as the Python type that a field of type `kind` takes."""
    if isinstance(kind, definition.AbstractNestedType):
        return _convert_array(value, kind, path, stamps)
    if isinstance(kind, definition.NamespacedType):
        message = getattr(importlib.import_module('.'.join(kind.namespaces)), kind.name)()
        _fill(message, value, path, stamps)
        return message
    if isinstance(kind, definition.AbstractGenericString):
        return _convert_string(value, kind, path)
    return _convert_basic(value, kind.typename, path)


def _convert_array(value: Any, kind: Any, path: str, stamps: list[StampSetter]) -> Any:
    if not isinstance(value, list):
        raise _FieldError(path, value, 'a list')
    if isinstance(kind, definition.Array) and len(value) != kind.size:
        raise _FieldError(path, value, f'{kind.size} elements, not {len(value)}')
    if isinstance(kind, definition.BoundedSequence) and len(value) > kind.maximum_size:
        raise _FieldError(path, value, f'at most {kind.maximum_size} elements, not {len(value)}')
    items = [
        _convert(item, kind.value_type, f'{path}[{index}]', stamps)
        for index, item in enumerate(value)
    ]
    if not isinstance(kind.value_type, definition.BasicType):
        return items
    numpy_type = _numpy_type(kind.value_type.typename)
    if numpy_type is None:
        return items
    if isinstance(kind, definition.Array):
        return np.array(items, dtype=numpy_type)
    return array.array(numpy_type.char, items)


def _numpy_type(type_name: str) -> np.dtype[Any] | None:
    """Return the element type of an array of numbers; None where arrays are plain lists."""
    if type_name in _INTEGERS:
        return np.dtype({'char': 'uint8', 'wchar': 'uint16'}.get(type_name, type_name))
    real = {'float': 'float32', 'double': 'float64'}.get(type_name)
    return np.dtype(real) if real else None


def _convert_string(value: Any, kind: Any, path: str) -> str:
    if isinstance(value, dict | list) or value is None:
        raise _FieldError(path, value, 'a string')
    text = str(value)
    if kind.has_maximum_size() and len(text) > kind.maximum_size:
        raise _FieldError(path, value, f'at most {kind.maximum_size} characters')
    return text


def _convert_basic(value: Any, type_name: str, path: str) -> bool | int | float | bytes:
    if type_name == 'boolean':
        if value in (0, 1) and isinstance(value, int):
            return bool(value)
        raise _FieldError(path, value, 'true or false')
    if type_name in _REALS:
        return _convert_real(value, path)
    if type_name == 'octet':
        return bytes([_convert_integer(value, 'a byte', 0, 256, path)])
    least, end = _INTEGERS[type_name]
    return _convert_integer(value, f'a {type_name}', least, end, path)


def _convert_real(value: Any, path: str) -> float:
    """Return a number; a text such as 1e3, which YAML 1.1 takes for a string, will do."""
    try:
        if isinstance(value, bool):
            raise ValueError
        return float(value)
    except (TypeError, ValueError) as error:
        raise _FieldError(path, value, 'a number') from error


def _convert_integer(value: Any, expected: str, least: int, end: int, path: str) -> int:
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    if not is_number or value != int(value) or not least <= value < end:
        raise _FieldError(path, value, f'{expected}, {least} to {end - 1}')
    return int(value)


def add_values_argument(parser: argparse.ArgumentParser, name: str, text: str) -> None:
    """Declare the argument `name` with the help `text`, and its alternative `--stdin`."""
    source = parser.add_mutually_exclusive_group()
    source.add_argument('values', metavar=name, nargs='?', default='{}', help=text)
    source.add_argument('--stdin', action='store_true', help=f'Read {name} from standard input')


def given_values(args: argparse.Namespace) -> dict[str, Any]:
    """Return the fields that the command line or standard input gives.

    Raises:
        CommandError: If they are no YAML, or no mapping of field names.
    """
    return read_values(sys.stdin.read() if args.stdin else args.values)
