# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Where each joint of the robot is in the arrays of a driver that has its own order and names."""

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from hexapod_sim.robot import JOINTS

_OURS = list(JOINTS)


def by_joint(names: Sequence[str], values: Sequence[float], field: str) -> NDArray[np.float64]:
    """Return a driver's numbers in the order of our joints (18,), matched by its names.

    Args:
        names: Of its joints.
        values: One number for each name, in any unit.
        field: What the numbers are, for texts.

    Raises:
        ValueError: a joint is missing or named twice, or names and numbers are not as many.
    """
    if len(values) != len(names):
        raise ValueError(
            f'{field} has {len(values)} numbers for {len(names)} names, expected one each'
        )
    order = joint_order(names)
    numbers = np.array(values, dtype=np.float64)
    return numbers if order is None else numbers[order]


def joint_order(names: Sequence[str]) -> NDArray[np.intp] | None:
    """Return the index of each of our joints among a driver's names; None if they are ours.

    A driver may publish the joints in any order, with further ones between them, and with one
    prefix for all of ours, such as 'robot_1/lf_hip' or 'phantomx_lf_hip'.

    Raises:
        ValueError: a joint is missing or named twice; the text names it.
    """
    if names == _OURS:
        return None
    return _order(tuple(names))


@lru_cache(maxsize=32)
def _order(names: tuple[str, ...]) -> NDArray[np.intp] | None:
    prefix = joint_prefix(names)
    wanted = [prefix + joint for joint in JOINTS]
    missing = [joint for joint in wanted if joint not in names]
    if missing:
        raise ValueError(f'name lacks {", ".join(missing)}, expected all 18 joints')
    twice = [joint for joint in wanted if names.count(joint) > 1]
    if twice:
        raise ValueError(f'name has {", ".join(twice)} twice, expected each joint once')
    if names == JOINTS:
        return None
    return np.array([names.index(joint) for joint in wanted])


def joint_prefix(names: Sequence[str]) -> str:
    """Return what a driver puts before the name of every joint; '' without a prefix of its own.

    Without a complete set under any prefix there is nothing to choose by, and it is '' as well.
    """
    first = JOINTS[0]
    had = set(names)
    for prefix in sorted((n[: -len(first)] for n in had if n.endswith(first)), key=len):
        if all(prefix + joint in had for joint in JOINTS):
            return prefix
    return ''
