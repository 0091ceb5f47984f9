# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Which topics of a bag can be played, and why others cannot; their messages."""

import re
from collections import Counter
from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass, field

from hexapod_doe.bags.bag_file import BagFile, RawMessage
from hexapod_doe.bags.decoding import is_cdr
from hexapod_doe.bags.definition import departure, is_unproven
from hexapod_doe.errors import BagError

_NAME = re.compile(r'^/?[A-Za-z_]\w*(/[A-Za-z_]\w*)*$', re.ASCII)


@dataclass
class Selection:
    """Topics of one bag to be published again, byte for byte."""

    bag: BagFile
    topics: list[str]
    """Those that subscribers will understand."""
    refused: dict[str, str]
    """Why each of the others is not played."""
    unproven: list[str]
    """Those of `topics` of which the bag tells the type's name alone."""
    skipped: Counter[str] = field(default_factory=Counter)
    """Messages that were none, by topic, as far as they were read."""

    def messages(self, start_ns: int | None = None) -> Iterator[RawMessage]:
        """Yield the messages from a time on, in the order of time; counts what is none.

        Raises:
            BagError: the bag is damaged.
        """
        for message in self.bag.messages(self.topics, start_ns):
            if is_cdr(message.data):
                yield message
            else:
                self.skipped[message.topic] += 1

    def warnings(self) -> list[str]:
        """Return a line for each topic that is not played, or not known to be what it says."""
        lines = [f'{topic} is not played: {reason}' for topic, reason in self.refused.items()]
        return lines + [
            f'{topic} has no definition in the bag: taken for {self.bag.types[topic]} as it is '
            'installed'
            for topic in self.unproven
        ]

    def skips(self) -> list[str]:
        """Return a line for each topic of which messages were left out."""
        return [
            f'{topic}: {count} messages are not serialised ones (CDR), and were not played'
            for topic, count in self.skipped.items()
        ]


def select(bag: BagFile, names: Collection[str], importable: Callable[[str], object]) -> Selection:
    """Choose the topics of a bag that can be played.

    Args:
        bag: which.
        names: whole names of the topics wanted.
        importable: called with the name of a type; raises ValueError where none is installed.

    Raises:
        BagError: none of them can; the text says why.
    """
    reasons = {name: _reason(bag, name, importable) for name in names}
    refused = {name: reason for name, reason in reasons.items() if reason}
    topics = [name for name in reasons if name not in refused]
    if names and not topics:
        first = next(iter(refused))
        raise BagError(f'bag {bag.path}: no topic can be played; {first}: {refused[first]}')
    hashes = _hashes(bag)
    unproven = [
        name
        for name in topics
        if any(is_unproven(topic, hashes[name]) for topic in bag.recorded.get(name, ()))
    ]
    return Selection(bag, topics, refused, unproven)


def _reason(bag: BagFile, name: str, importable: Callable[[str], object]) -> str:
    """Return why a topic cannot be played; '' if it can."""
    if not _NAME.match(name):
        return 'ROS 2 has no such names, expected letters, digits and _ between slashes'
    kinds = bag.types_of(name)
    if len(kinds) > 1:
        return f'it was recorded with the types {" and ".join(kinds)}, expected one'
    for topic in bag.recorded.get(name, ()):
        reason = departure(topic, _hashes(bag)[name])
        if reason:
            return reason
    try:
        importable(bag.types[name])
    except ValueError as error:
        return str(error)
    return ''


def _hashes(bag: BagFile) -> dict[str, str]:
    return {topic.name: topic.type_hash for topic in bag.about.topics}
