# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What can be told of a serialised message without decoding it: its encoding and its stamp."""

import struct

from zstandard import ZstdDecompressor

_NANOSECONDS = 1_000_000_000
# Four bytes say how the rest is encoded (DDS-XTYPES 1.3, 7.6.3.1.2), the second its byte order;
# then come int32 sec and uint32 nanosec of builtin_interfaces/Time, wherever a message begins
# with a header or a stamp.
_LITTLE = struct.Struct('<4xiI')
_BIG = struct.Struct('>4xiI')
_HEADER_BYTES = 4
# Of the identifiers in the same table ROS 2 uses plain CDR alone, big (0) and little endian (1).
_ENCODINGS = (0, 1)
_ZSTD_MAGIC = b'\x28\xb5\x2f\xfd'


def is_cdr(data: bytes) -> bool:
    """Whether a message begins as every one of ROS 2 does."""
    return len(data) >= _HEADER_BYTES and data[0] == 0 and data[1] in _ENCODINGS


def decompressed(data: bytes) -> bytes:
    """Return a message that rosbag2 compressed by itself as it was; any other as it is.

    No serialised message begins as zstd does, so metadata.yaml need not say which ones are.

    Raises:
        ValueError, zstandard.ZstdError: it is damaged.
    """
    if not data.startswith(_ZSTD_MAGIC):
        return data
    stream = ZstdDecompressor().decompressobj()
    whole = stream.decompress(data)
    if not stream.eof:
        raise ValueError('a compressed message is cut short')
    return whole


def stamp_ns(data: bytes) -> int:
    """Return the stamp of a message that begins with one, in nanoseconds.

    Raises:
        ValueError: too short for a stamp.
    """
    if len(data) < _LITTLE.size:
        raise ValueError(f'a message of {len(data)} bytes is too short to begin with a stamp')
    sec, nanosec = (_LITTLE if data[1] & 1 else _BIG).unpack_from(data)
    return int(sec) * _NANOSECONDS + int(nanosec)
