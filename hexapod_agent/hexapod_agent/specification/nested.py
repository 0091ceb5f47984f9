# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Nested mappings of plain values, as a specification's text holds them."""

from collections.abc import Mapping
from typing import Any


def flat(mapping: Mapping[str, Any], prefix: str = '') -> dict[str, Any]:
    """Return nested values by their dotted keys."""
    values: dict[str, Any] = {}
    for key, value in mapping.items():
        nested = flat(value, f'{prefix}{key}.') if isinstance(value, Mapping) else None
        values |= nested if nested is not None else {f'{prefix}{key}': value}
    return values


def merged(base: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """Return `base` with the values of `changes`, section by section."""
    found = dict(base)
    for key, value in changes.items():
        nested = isinstance(value, Mapping) and isinstance(found.get(key), Mapping)
        found[key] = merged(found[key], value) if nested else value
    return found


def nest(key: str, value: Any) -> dict[str, Any]:
    """Return the one value of a dotted key as nested values."""
    *sections, name = key.split('.')
    found = {name: value}
    for section in reversed(sections):
        found = {section: found}
    return found
