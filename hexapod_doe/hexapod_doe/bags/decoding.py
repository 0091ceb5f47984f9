# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Decodes messages of an MCAP file by the definitions in it; tells what is CDR."""

import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

from mcap.records import Channel, Message, Schema
from mcap_ros2.decoder import DecoderFactory
from zstandard import ZstdDecompressor

from hexapod_doe.errors import BagError

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


_LONGEST = 120


class Decoders:
    """The decoders of one file, by channel."""

    def __init__(self, bag: Path) -> None:
        """Begin with none.

        Args:
            bag: named in errors.
        """
        self._bag = bag
        self._by_channel: dict[int, Callable[[bytes], Any]] = {}

    def decode(self, schema: Schema | None, channel: Channel, message: Message) -> Any:
        """Return a message, decoded.

        Raises:
            BagError: its definition cannot be used, or the message is not of it.
        """
        if channel.id not in self._by_channel:
            self._by_channel[channel.id] = self._decoder(channel, schema)
        try:
            return self._by_channel[channel.id](decompressed(message.data))
        except Exception as error:  # bytes that are no message raise anything
            raise BagError(
                f'bag {self._bag}: {channel.topic}: the message of {message.log_time} ns '
                f'cannot be decoded ({short(error)}), expected {schema and schema.name} as the '
                'bag defines it'
            ) from error

    def _decoder(self, channel: Channel, schema: Schema | None) -> Callable[[bytes], Any]:
        try:
            decoder = DecoderFactory().decoder_for(channel.message_encoding, schema)
        except Exception as error:  # so does a text that is no definition
            reason = f'its definition cannot be understood ({short(error)})'
            raise self._undecodable(channel, schema, reason) from error
        if decoder is None:
            language = schema.encoding or 'nothing' if schema else 'nothing'
            reason = f'defined in {language}, messages in {channel.message_encoding or "nothing"}'
            raise self._undecodable(channel, schema, reason)
        return decoder

    def _undecodable(self, channel: Channel, schema: Schema | None, reason: str) -> BagError:
        kind = f' of type {schema.name}' if schema else ''
        return BagError(
            f'bag {self._bag}: {channel.topic}{kind} cannot be decoded: {reason}, '
            'expected a definition in ros2msg and messages in cdr'
        )


def short(error: BaseException) -> str:
    """Return what an error says in one line of reasonable length: some quote pages of bytes."""
    text = ' '.join(str(error).split()) or type(error).__name__
    return text if len(text) <= _LONGEST else f'{text[: _LONGEST - 1]}…'
