# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Find message, service and action types by name, and their definitions on disk."""

import importlib
from pathlib import Path
from typing import Any

from ament_index_python import get_resource, get_resources, has_resource

from ros2_mini.errors import CommandError
from ros2_mini.packages import package_share

KINDS = {'msg': 'message', 'srv': 'service', 'action': 'action'}


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


def interface_names(kind: str) -> list[str]:
    """Return the names of all installed interfaces of a kind, such as `std_msgs/msg/String`."""
    names = set()
    for package in get_resources('rosidl_interfaces'):
        content, _ = get_resource('rosidl_interfaces', package)
        stems = {Path(line).with_suffix('') for line in content.splitlines()}
        names |= {f'{package}/{stem}' for stem in stems if stem.parts[0] == kind}
    # Names with an underscore belong to the parts of services and actions.
    return sorted(name for name in names if '_' not in name.rpartition('/')[2])


def definition_path(name: str) -> Path:
    """Return the file that defines an interface.

    Args:
        name: Such as `std_msgs/msg/String`.

    Raises:
        CommandError: If the name is malformed or unknown.
    """
    parts = name.split('/')
    if len(parts) != 3 or '..' in parts or not all(parts):
        raise CommandError(f"Invalid name '{name}'. Expected three parts separated by '/'")
    package, kind, interface = parts
    if not has_resource('packages', package):
        raise CommandError(f"Unknown package '{package}'")
    stem = package_share(package) / kind / interface
    for suffix in (kind, 'idl'):
        path = stem.with_name(f'{interface}.{suffix}')
        if path.exists():
            return path
    raise CommandError(f"Could not find the interface '{stem}.idl'")
