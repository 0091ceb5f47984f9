# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Reads a closed bag from end to end and compares it with what its recorder counted."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

from hexapod_doe.bags.bag_file import BagFile
from hexapod_doe.bags.digest import Digest
from hexapod_doe.bags.run_bag import DIGEST, EPISODE_RESULT
from hexapod_doe.errors import BagError


def verify(bag: str | Path) -> None:
    """Check the bag of a run: its messages, their digest, and that each episode is there once.

    A bag of an earlier version, which does not state its digest, passes without that check.

    Raises:
        BagError: the bag cannot be read to its end, or is not what it says.
    """
    file = BagFile(bag)
    metadata = file.run_metadata()
    check_messages(file, metadata.get(DIGEST))
    _check_episodes(file, int(metadata['episodes']))


def check_messages(file: BagFile, digest: str | None) -> None:
    """Read every message and compare their number per topic, and their digest.

    Raises:
        BagError: the bag cannot be read to its end, or is not what it says.
    """
    counts: Counter[str] = Counter()
    found = Digest()
    for message in file.messages():
        counts[message.topic] += 1
        found.add(message.topic, message.data, message.time_ns)
    for topic, expected in file.counts.items():
        if counts[topic] != expected:
            raise BagError(
                f'bag {file.path}: {counts[topic]} messages of {topic}, expected {expected}'
            )
    read = found.hexdigest(file.types)
    if digest is not None and read != digest:
        raise BagError(f'bag {file.path}: digest {read}, expected {digest} as recorded')


def _check_episodes(file: BagFile, episodes: int) -> None:
    topics = [topic for topic, name in file.types.items() if name == EPISODE_RESULT]
    numbers = sorted(result.episode for topic in topics for _, result in file.decoded(topic))
    if numbers != list(range(episodes)):
        odd = next((n for n, found in enumerate(numbers) if n != found), len(numbers))
        raise BagError(
            f'bag {file.path}: {len(numbers)} episode results, the first fault at episode {odd}; '
            f'expected each of {episodes} once'
        )
