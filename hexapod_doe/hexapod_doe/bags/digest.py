# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A fingerprint of what a bag holds, equal for equal runs wherever and whenever they ran."""

from __future__ import annotations

import hashlib
import struct
from pathlib import Path

from hexapod_doe.bags.bag_file import BagFile
from hexapod_doe.bags.playback import frames


def digest(bag: str | Path) -> str:
    """Return the SHA-256, in hexadecimal, of every message, its topic and its time.

    Neither the order in which messages of one instant arrived counts, nor the namespace of the
    worker that the run was on, nor metadata.

    Raises:
        hexapod_doe.errors.BagError: the bag cannot be read to its end.
    """
    file = BagFile(bag)
    namespace = _namespace(file.types)
    total = hashlib.sha256()
    for frame in frames(file.messages()):
        for message in sorted(frame.messages):
            topic = message.topic.removeprefix(namespace).encode()
            total.update(struct.pack('<QQQ', message.time_ns, len(topic), len(message.data)))
            total.update(topic)
            total.update(message.data)
    return total.hexdigest()


def _namespace(topics: dict[str, str]) -> str:
    """Return the start, up to a slash, that all topics share."""
    parts = [topic.split('/')[:-1] for topic in topics]
    shared: list[str] = []
    for column in zip(*parts, strict=False):
        if len(set(column)) > 1:
            break
        shared.append(column[0])
    return '/'.join([*shared, ''])
