# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Finds the text and the hash of message types in the installed ROS packages, for bags.

A bag explains itself: each channel carries the `.msg` text of its type and of every type that it
is made of, in the form that rosbag2's MCAP storage writes
(https://mcap.dev/spec/registry#ros2msg), so that any reader decodes it without our packages.
"""

import json
import re
from functools import cache
from pathlib import Path

from ament_index_python import PackageNotFoundError, get_package_share_path

from hexapod_doe.errors import BagError

_PRIMITIVES = frozenset(
    [
        'bool',
        'byte',
        'char',
        'float32',
        'float64',
        'string',
        'wstring',
        *(f'{sign}int{bits}' for sign in ('', 'u') for bits in (8, 16, 32, 64)),
    ]
)
_TYPE_NAME = re.compile(r'^([A-Za-z]\w*)/(?:msg/)?([A-Za-z]\w*)$')
# A field's type is the first word of its line, less array and string bounds; a constant is told
# from a field by its equals sign, but constants are primitive and need no text of their own.
_FIELD_TYPE = re.compile(r'^\s*([A-Za-z][\w/]*)', re.MULTILINE)
_SEPARATOR = '=' * 80
_STAMPED = ('std_msgs/Header', 'builtin_interfaces/Time')


@cache
def definition(type_name: str) -> str:
    """Return the full text of a message type such as 'sensor_msgs/msg/Imu'.

    Raises:
        BagError: the type, or one that it is made of, is not installed.
    """
    parts = [_text(type_name)]
    seen: set[str] = set()
    _append_dependencies(type_name, parts, seen)
    return ''.join(parts)


@cache
def type_hash(type_name: str) -> str:
    """Return the RIHS01 hash of a message type (REP 2016), '' where none is installed."""
    path = _path(type_name, '.json')
    if not path.is_file():
        return ''
    package, name = _split(type_name)
    for entry in json.loads(path.read_text(encoding='utf-8'))['type_hashes']:
        if entry['type_name'] == f'{package}/msg/{name}':
            return str(entry['hash_string'])
    return ''


@cache
def is_stamped(type_name: str) -> bool:
    """Whether messages of the type begin with a time: a header, or a bare stamp."""
    fields = _field_types(type_name)
    return bool(fields) and fields[0] in _STAMPED


def _append_dependencies(type_name: str, parts: list[str], seen: set[str]) -> None:
    # Depth first, names in sorted order: the order in which rosbag2 writes them.
    for dependency in sorted(set(_field_types(type_name)) - _PRIMITIVES):
        if dependency not in seen:
            seen.add(dependency)
            parts.append(f'\n{_SEPARATOR}\nMSG: {dependency}\n{_text(dependency)}')
            _append_dependencies(dependency, parts, seen)


@cache
def _field_types(type_name: str) -> tuple[str, ...]:
    package, _ = _split(type_name)
    found = _FIELD_TYPE.findall(_text(type_name))
    return tuple(
        name if '/' in name or name in _PRIMITIVES else f'{package}/{name}' for name in found
    )


@cache
def _text(type_name: str) -> str:
    path = _path(type_name, '.msg')
    if not path.is_file():
        raise BagError(f"message type '{type_name}': no {path}, expected an installed definition")
    return path.read_text(encoding='utf-8')


def _path(type_name: str, suffix: str) -> Path:
    package, name = _split(type_name)
    try:
        share = get_package_share_path(package)
    except PackageNotFoundError as error:
        raise BagError(
            f"message type '{type_name}': package '{package}' is not in AMENT_PREFIX_PATH"
        ) from error
    return share / 'msg' / f'{name}{suffix}'


def _split(type_name: str) -> tuple[str, str]:
    match = _TYPE_NAME.match(type_name)
    if match is None:
        raise BagError(f"message type '{type_name}': expected <package>/msg/<Type>")
    return match.group(1), match.group(2)
