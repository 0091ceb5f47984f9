# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Decodes messages of an MCAP file by the definitions that stand in it."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from mcap.records import Channel, Message, Schema
from mcap_ros2.decoder import DecoderFactory

from hexapod_doe.bags.cdr import decompressed
from hexapod_doe.errors import BagError

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
