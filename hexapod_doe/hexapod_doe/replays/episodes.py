# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Episodes of a bag with all their topics, and the samples of a topic by their stamps."""

from bisect import bisect_right
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from hexapod_doe.bags.bag_file import BagFile
from hexapod_doe.bags.run_bag import EPISODE_RESULT
from hexapod_doe.errors import BagError

ODOMETRY = 'nav_msgs/msg/Odometry'
LINE_OFFSET = 'hexapod_interfaces/msg/LineOffset'
STEP_OUTCOME = 'hexapod_interfaces/msg/StepOutcome'


@dataclass(frozen=True)
class Span:
    """An episode of a bag, with its first and last stamp."""

    episode: int
    """Number in its run; in the bag, where the run does not tell."""
    start_ns: int
    end_ns: int


class Series:
    """The samples of one topic in the order of their stamps.

    Attributes:
        topic: full name.
        stamps: of the samples, in nanoseconds; a stamp that comes twice counts once.
    """

    def __init__(self, bag: BagFile, name: str, kind: str) -> None:
        """Read a topic.

        Args:
            bag: where from.
            name: of the topic, or its end.
            kind: its message type.

        Raises:
            BagError: there is no such topic of that type, or it is empty or damaged.
        """
        self.topic = bag.topic(name, kind)
        messages = (message for _, message in bag.decoded(self.topic))
        self._samples = {_stamp_ns(message.header.stamp): message for message in messages}
        self.stamps = sorted(self._samples)
        if not self.stamps:
            raise BagError(f'bag {bag.path}: topic {self.topic} is empty, expected its samples')

    def at(self, stamp_ns: int) -> Any:
        """Return the sample of a stamp, or None."""
        return self._samples.get(stamp_ns)

    def newest(self, stamp_ns: int) -> Any:
        """Return the last sample that is not later than a stamp, or None."""
        index = bisect_right(self.stamps, stamp_ns)
        return self._samples[self.stamps[index - 1]] if index else None

    def within(self, span: Span) -> list[int]:
        """Return the stamps of an episode."""
        return [stamp for stamp in self.stamps if span.start_ns <= stamp <= span.end_ns]


def series_of_type(bag: BagFile, kind: str) -> Series | None:
    """Return the samples of the one topic of a type; None if there is none.

    Raises:
        BagError: there are several, or the one is empty or damaged.
    """
    return Series(bag, bag.topic_of_type(kind), kind) if kind in bag.types.values() else None


def recorded_episodes(bag: BagFile, clock: Series) -> list[Span]:
    """Return the episodes of which a bag holds more than their result.

    An episode begins with the outcome of step 0. A bag without outcomes is one episode.

    Args:
        bag: which.
        clock: the topic whose samples span a bag without outcomes.

    Raises:
        BagError: the bag holds outcomes, but the begin of no episode.
    """
    outcomes = series_of_type(bag, STEP_OUTCOME)
    if outcomes is None:
        return [Span(0, clock.stamps[0], clock.stamps[-1])]
    begins = [i for i, stamp in enumerate(outcomes.stamps) if outcomes.at(stamp).step == 0]
    if not begins:
        raise BagError(f'bag {bag.path}: {outcomes.topic} has no step 0, expected one per episode')
    has = EPISODE_RESULT in bag.types.values()
    results = Series(bag, bag.result_topic(), EPISODE_RESULT) if has else None
    spans = []
    for position, (begin, end) in enumerate(pairwise([*begins, len(outcomes.stamps)])):
        first, last = outcomes.stamps[begin], outcomes.stamps[end - 1]
        result = results.at(last) if results else None
        spans.append(Span(result.episode if result else position, first, last))
    return spans


def episode_of(number: int, spans: Iterable[Span], bag: BagFile) -> Span:
    """Return the episode of a number.

    Raises:
        BagError: there is none.
    """
    by_number = {span.episode: span for span in spans}
    if number not in by_number:
        have = ', '.join(map(str, by_number))
        raise BagError(
            f'bag {bag.path}: episode {number} with all its topics expected, it has {have}'
        )
    return by_number[number]


def _stamp_ns(stamp: Any) -> int:
    return int(stamp.sec) * 1_000_000_000 + int(stamp.nanosec)
