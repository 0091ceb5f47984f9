# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Simulated time as whole nanoseconds, to and from ROS messages."""

from builtin_interfaces.msg import Duration, Time

NANOSECONDS = 1_000_000_000


def time_message(nanoseconds: int) -> Time:
    """Return a stamp. Integers all the way: two nodes that mean the same period say the same."""
    seconds, rest = divmod(nanoseconds, NANOSECONDS)
    return Time(sec=seconds, nanosec=rest)


def duration_message(nanoseconds: int) -> Duration:
    """Return a duration."""
    seconds, rest = divmod(nanoseconds, NANOSECONDS)
    return Duration(sec=seconds, nanosec=rest)


def to_nanoseconds(message: Time | Duration) -> int:
    """Return the whole nanoseconds of a stamp or a duration."""
    return int(message.sec) * NANOSECONDS + int(message.nanosec)
