# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Messages and requests of any type, with hostile values by a seed."""

from __future__ import annotations

import re
from array import array
from collections.abc import Sequence
from functools import cache
from importlib import import_module
from typing import Any

import numpy as np

INTEGERS = {
    f'{sign}int{bits}': (0, 2**bits - 1) if sign else (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)
    for sign in ('', 'u')
    for bits in (8, 16, 32, 64)
}
REALS = (0.0, -0.0, 1.0, 1e-300, 1e10, -1e10, 1e300, -1e300, np.nan, np.inf, -np.inf)
SINGLE = 3e38
LENGTHS = (0, 1, 2, 6, 17, 18, 19, 500)
WORDS = (
    '', 'a', '/', '~', '.', '..', '/odom', 'sim', 'lf_hip', '%s%n', 'ü\n', 'a b', '{}', 'nan',
    '-1', 'ABCDE', 'ABX', 'article.yaml', 'tripod', '**', '[', 'x' * 300, 'x' * 70_000,
)  # fmt: skip


class HostileValues:
    """Makes up messages whose fields hold what nobody should send."""

    def __init__(self, random: np.random.Generator, paths: Sequence[str]) -> None:
        """Begin with what draws the values, and paths to name where a request takes one."""
        self._random = random
        self._paths = paths

    def value(self, kind: type, where: str = '') -> Any:
        """Return a message of a type with a hostile value in every field."""
        made: Any = kind()
        for name, type_name in made.get_fields_and_field_types().items():
            setattr(made, name, self.field(type_name, name))
        return made

    def field(self, type_name: str, name: str) -> Any:
        """Return a hostile value of a field's type."""
        sequence = re.fullmatch(r'sequence<([^,]+)(?:, (\d+))?>', type_name)
        fixed = re.fullmatch(r'(.+)\[(\d+)\]', type_name)
        if sequence or fixed:
            length = int(fixed[2]) if fixed else int(self._random.choice(LENGTHS))
            if sequence and sequence[2]:
                length = min(length, int(sequence[2]))
            inner = (sequence or fixed)[1]  # type: ignore[index]
            if '/' in inner:
                length = min(length, 2)
            return self._items(inner, name, length, bool(fixed))
        return self._one(type_name, name)

    def _items(self, inner: str, name: str, length: int, fixed: bool) -> Any:
        # Requests of megabytes that follow one another get lost on their way out, by DDS.
        items = [self._one(inner, name) for _ in range(length)]
        items = [item[:300] if isinstance(item, str) else item for item in items]
        code = {
            'double': 'd',
            'float': 'f',
            'uint8': 'B',
            'int8': 'b',
            'int32': 'i',
            'uint32': 'I',
        }
        if inner in ('octet', 'byte'):
            return items
        if fixed and inner in ('double', 'float', 'uint8'):
            return np.array(items, dtype={'double': 'f8', 'float': 'f4', 'uint8': 'u1'}[inner])
        return array(code[inner], items) if inner in code else items

    def _one(self, type_name: str, name: str) -> Any:
        chance = self._random
        if type_name in INTEGERS:
            low, high = INTEGERS[type_name]
            picks = (low, high, 0, 1, high // 2, int(chance.integers(0, 100)))
            return min(max(picks[chance.integers(len(picks))], low), high)
        if type_name in ('double', 'float'):
            value = float(chance.choice(REALS))
            return float(np.clip(value, -SINGLE, SINGLE)) if type_name == 'float' else value
        if type_name == 'boolean':
            return bool(chance.random() < 0.5)
        if type_name in ('octet', 'byte'):
            return bytes([int(chance.integers(256))])
        if type_name.startswith(('string', 'wstring')):
            return self._text(name)
        return self.value(import_class(type_name), name)

    def _text(self, name: str) -> str:
        paths = name in ('bag', 'checkpoint') or self._random.random() < 0.1
        pool = self._paths if paths and self._random.random() < 0.8 else WORDS
        return str(pool[self._random.integers(len(pool))])


@cache
def import_class(type_name: str) -> Any:
    """Return the class of 'package/msg/Type', or of the 'package/Type' of a field."""
    package, *_, name = type_name.split('/')
    part = re.fullmatch(r'(.+)_(Goal|Result|Feedback|FeedbackMessage)', name)
    if part:
        action = getattr(import_module(f'{package}.action'), part[1])
        return getattr(action.Impl if part[2] == 'FeedbackMessage' else action, part[2])
    return getattr(import_module(f'{package}.msg'), name)


@cache
def service_class(type_name: str) -> Any:
    """Return the class of a service, those of actions included."""
    package, kind, name = type_name.split('/')
    module = import_module(f'{package}.{kind}')
    action = re.fullmatch(r'(.+)_(SendGoal|GetResult)', name)
    if kind == 'action' and action:
        return getattr(getattr(module, action[1]).Impl, f'{action[2]}Service')
    return getattr(module, name)
