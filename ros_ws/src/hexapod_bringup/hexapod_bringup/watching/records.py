# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What is kept of messages, in plain values; they are told by their fields alone."""

import math
from collections.abc import Sequence
from typing import Any

from hexapod_bringup.watching.board import Pose

MOST_TERMS = 64
"""Of a reward or of metrics; what a message has beyond them is left out."""


def stamp_s(message: Any) -> float:
    """Return the stamp of a message, s."""
    stamp = message.header.stamp
    return round(float(stamp.sec + stamp.nanosec * 1e-9), 3)


def pose_of(message: Any) -> Pose | None:
    """Return where base_link is in odom; None if it is no pose."""
    p, q = message.pose.pose.position, message.pose.pose.orientation
    numbers = (p.x, p.y, p.z, q.x, q.y, q.z, q.w)
    if not all(map(math.isfinite, numbers)) or not any(numbers[3:]):
        return None
    return Pose((p.x, p.y, p.z), (q.x, q.y, q.z, q.w))


def outcome_record(message: Any) -> dict[str, Any]:
    """Return what a control period earned, in plain values."""
    return {
        'step': message.step,
        'reward': finite(message.reward),
        'terms': named(message.term_names, message.term_values),
        'cause': message.cause,
        'time': stamp_s(message),
    }


def result_record(message: Any) -> dict[str, Any]:
    """Return the result of an episode in plain values."""
    return {
        'run': message.run_id,
        'episode': message.episode,
        'steps': message.steps,
        'return': finite(message.episode_return),
        'average': finite(message.average_return),
        'cause': message.cause,
        'terms': named(message.term_names, message.term_values),
        'metrics': named(message.metric_names, message.metric_values),
    }


def named(names: Sequence[str], values: Sequence[float]) -> dict[str, float | None]:
    """Return values by name."""
    pairs = zip(names[:MOST_TERMS], values[:MOST_TERMS], strict=False)
    return {name: finite(value) for name, value in pairs}


def finite(value: float) -> float | None:
    """Return a number that JSON has; None for what is none."""
    return round(float(value), 5) if math.isfinite(value) else None
