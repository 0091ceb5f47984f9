# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Simulated time as whole nanoseconds, to and from ROS messages."""

from builtin_interfaces.msg import Duration, Time

NANOSECONDS = 1_000_000_000
_LAST_S = 2**31 - 1
# Simulated time that a peer may ask for: from its start to a year before stamps end.
_LAST_START_S = _LAST_S - 366 * 86_400


def time_message(nanoseconds: int) -> Time:
    """Return a stamp. Integers all the way: two nodes that mean the same period say the same.

    Raises:
        ValueError: a stamp does not reach so far.
    """
    seconds, rest = divmod(nanoseconds, NANOSECONDS)
    if not -_LAST_S <= seconds <= _LAST_S:
        raise ValueError(f'time {seconds} s: out of the range of stamps, {_LAST_S} s')
    return Time(sec=seconds, nanosec=rest)


def duration_message(nanoseconds: int) -> Duration:
    """Return a duration."""
    seconds, rest = divmod(nanoseconds, NANOSECONDS)
    return Duration(sec=seconds, nanosec=rest)


def to_nanoseconds(message: Time | Duration) -> int:
    """Return the whole nanoseconds of a stamp or a duration."""
    nanoseconds: int = message.sec * NANOSECONDS + message.nanosec
    return nanoseconds


def requested_start_ns(message: Time) -> int:
    """Return the start that a request asks for, in nanoseconds.

    Raises:
        ValueError: it is before the start of time, or leaves no room for episodes after it.
    """
    if not 0 <= message.sec <= _LAST_START_S:
        raise ValueError(f'start {message.sec} s: expected 0 to {_LAST_START_S} s')
    return to_nanoseconds(message)
