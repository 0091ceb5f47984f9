# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A fingerprint of the messages in a bag, whatever their order and whichever worker sent them.

It is of their bytes: a message that was serialised anew may differ in its padding alone, which
CDR leaves to chance.
"""

import hashlib
import struct
from collections.abc import Iterable
from pathlib import Path

from hexapod_doe.bags.bag_file import BagFile

_MODULUS = 1 << 256


class Digest:
    """The fingerprint while messages come, in whatever order.

    SHA-256 of every message with its time, added up modulo 2^256 per topic: an incremental hash
    of a multiset (Bellare and Micciancio, EUROCRYPT 1997). It tells damage, not forgery.
    """

    def __init__(self) -> None:
        self._sums: dict[str, int] = {}

    def add(self, topic: str, data: bytes, time_ns: int) -> None:
        """Take in one message."""
        one = hashlib.sha256(struct.pack('<Q', time_ns))
        one.update(data)
        number = int.from_bytes(one.digest(), 'little')
        self._sums[topic] = (self._sums.get(topic, 0) + number) % _MODULUS

    def hexdigest(self, topics: Iterable[str]) -> str:
        """Return the fingerprint of a bag that lists these topics, those without messages too."""
        namespace = _namespace(topics)
        sums = {topic.removeprefix(namespace): value for topic, value in self._sums.items()}
        total = hashlib.sha256()
        for topic, value in sorted(sums.items()):
            total.update(struct.pack('<Q', len(topic.encode())))
            total.update(topic.encode())
            total.update(value.to_bytes(32, 'little'))
        return total.hexdigest()


def digest(bag: str | Path) -> str:
    """Return the SHA-256, in hexadecimal, of every message, its topic and its time.

    Neither the order of messages counts, nor the namespace of the worker that the run was on, nor
    metadata.

    Raises:
        hexapod_doe.errors.BagError: the bag cannot be read to its end.
    """
    file = BagFile(bag)
    total = Digest()
    for message in file.messages():
        total.add(message.topic, message.data, message.time_ns)
    return total.hexdigest(file.types)


def _namespace(topics: Iterable[str]) -> str:
    """Return the start, up to a slash, that all topics share."""
    parts = [topic.split('/')[:-1] for topic in topics]
    shared: list[str] = []
    for column in zip(*parts, strict=False):
        if len(set(column)) > 1:
            break
        shared.append(column[0])
    return '/'.join([*shared, ''])
