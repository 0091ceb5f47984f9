# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Reads the time stamp at the head of a serialised message, without decoding the rest."""

from __future__ import annotations

import struct

_NANOSECONDS = 1_000_000_000
# Four bytes say how the rest is encoded (DDS-XTYPES 1.3, 7.6.3.1.2), the second its byte order;
# then come int32 sec and uint32 nanosec of builtin_interfaces/Time, wherever a message begins
# with a header or a stamp.
_LITTLE = struct.Struct('<4xiI')
_BIG = struct.Struct('>4xiI')


def stamp_ns(data: bytes) -> int:
    """Return the stamp of a message that begins with one, in nanoseconds.

    Raises:
        ValueError: too short for a stamp.
    """
    if len(data) < _LITTLE.size:
        raise ValueError(f'a message of {len(data)} bytes is too short to begin with a stamp')
    sec, nanosec = (_LITTLE if data[1] & 1 else _BIG).unpack_from(data)
    return int(sec) * _NANOSECONDS + int(nanosec)
