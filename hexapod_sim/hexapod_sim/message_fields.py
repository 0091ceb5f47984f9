# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Numbers of a message's field by its path, whichever library made the message.

Messages are told by their fields alone, so that nothing here needs ROS. What a field holds is
looked at in the first message of a type; this runs for every sensor in every control period.
"""

from array import array
from collections.abc import Callable
from operator import attrgetter
from typing import Any

import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[np.float64]
_Key = tuple[type, str]
_readers: dict[_Key, Callable[[Any], Numbers]] = {}
_writers: dict[_Key, Callable[[Any, Numbers], None]] = {}


def read(message: Any, path: str) -> Numbers:
    """Return the numbers of a field: a scalar, an array, x y z, or x y z w."""
    key = type(message), path
    reader = _readers.get(key)
    if reader is None:
        reader = _readers[key] = _reader(message, path)
    return reader(message)


def write(message: Any, path: str, values: Numbers) -> None:
    """Write the numbers of a field in the type that it has."""
    key = type(message), path
    writer = _writers.get(key)
    if writer is None:
        writer = _writers[key] = _writer(message, path)
    writer(message, values)


def _reader(message: Any, path: str) -> Callable[[Any], Numbers]:
    get = attrgetter(path)
    value = get(message)
    if hasattr(value, 'x'):
        axes = 'xyzw' if hasattr(value, 'w') else 'xyz'
        get_axes = attrgetter(*(f'{path}.{axis}' for axis in axes))
        return lambda message: np.array(get_axes(message), dtype=np.float64)
    if np.ndim(value):
        return lambda message: np.array(get(message), dtype=np.float64)
    return lambda message: np.array((get(message),), dtype=np.float64)


def _writer(message: Any, path: str) -> Callable[[Any, Numbers], None]:
    owner_path, _, name = path.rpartition('.')
    owner = attrgetter(owner_path) if owner_path else _itself
    had = getattr(owner(message), name)
    if hasattr(had, 'x'):
        get = attrgetter(path)

        def write_vector(message: Any, values: Numbers) -> None:
            vector = get(message)
            vector.x, vector.y, vector.z = values.tolist()

        def write_quaternion(message: Any, values: Numbers) -> None:
            quaternion = get(message)
            quaternion.x, quaternion.y, quaternion.z, quaternion.w = values.tolist()

        return write_quaternion if hasattr(had, 'w') else write_vector
    if isinstance(had, float):
        return lambda message, values: setattr(owner(message), name, float(values[0]))
    if isinstance(had, array):
        return lambda message, values: setattr(owner(message), name, array('d', values.tobytes()))
    return lambda message, values: setattr(owner(message), name, (values > 0.5).tolist())


def _itself(message: Any) -> Any:
    return message
