# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Says of one recorded episode whether every topic delivered every control period, once."""

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from itertools import pairwise

# What is commanded for a control period is stamped with its start, so the last sample of an
# episode, where its last period ends, has no command.
COMMAND_TYPES = frozenset(
    ('hexapod_interfaces/msg/CpgCommand', 'trajectory_msgs/msg/JointTrajectory')
)


@dataclass(frozen=True)
class TopicVerdict:
    """What one topic delivered in one episode, against what was due."""

    topic: str
    messages: int
    due: int
    missing: int = 0
    duplicate: int = 0
    out_of_order: int = 0
    stray: int = 0
    """Stamps that belong to no period of the episode."""
    first_missing_ns: int = 0

    @property
    def complete(self) -> bool:
        """Whether nothing is amiss."""
        return not (self.missing or self.duplicate or self.out_of_order or self.stray)

    def __str__(self) -> str:
        parts = [f'{self.topic}: {self.messages} of {self.due}']
        if self.missing:
            parts.append(f'{self.missing} missing from {self.first_missing_ns * 1e-9:.3f} s')
        parts += [
            f'{count} {name.replace("_", " ")}'
            for name in ('duplicate', 'out_of_order', 'stray')
            if (count := getattr(self, name))
        ]
        return ', '.join(parts)


class EpisodeTally:
    """The stamps that the topics of one episode delivered."""

    def __init__(self, types: Mapping[str, str], period_ns: int) -> None:
        """Begin an episode.

        Args:
            types: message type by topic; only stamped ones.
            period_ns: control period; 0 where samples keep no common grid.
        """
        self._types = dict(types)
        self._period_ns = period_ns
        self._stamps: dict[str, list[int]] = {topic: [] for topic in types}

    def add(self, topic: str, stamp_ns: int) -> None:
        """Take note of one message."""
        self._stamps[topic].append(stamp_ns)

    def waiting(self, last_ns: int) -> list[str]:
        """Return the topics that have not yet delivered their last stamp of the episode."""
        return [
            topic
            for topic, stamps in self._stamps.items()
            if not stamps or max(stamps) < self._end_ns(topic, last_ns)
        ]

    def periods(self, last_ns: int) -> int:
        """Return how many control periods the episode lasted, from its first stamp to the last."""
        return (last_ns - self._first_ns(last_ns)) // self._period_ns if self._period_ns else 0

    def verdicts(self, last_ns: int) -> list[TopicVerdict]:
        """Judge every topic, now that the episode ended at `last_ns`."""
        first_ns = self._first_ns(last_ns)
        return [self._verdict(topic, first_ns, last_ns) for topic in self._stamps]

    def _first_ns(self, last_ns: int) -> int:
        return min((min(stamps) for stamps in self._stamps.values() if stamps), default=last_ns)

    def _verdict(self, topic: str, first_ns: int, last_ns: int) -> TopicVerdict:
        stamps = self._stamps[topic]
        found = set(stamps)
        backward = sum(b < a for a, b in pairwise(stamps))
        due: Collection[int] = found
        if self._period_ns:  # not a set: a stamp that is wrong may make it as long as time
            due = range(first_ns, self._end_ns(topic, last_ns) + 1, self._period_ns)
        on_grid = sum(stamp in due for stamp in found)
        return TopicVerdict(
            topic,
            messages=len(stamps),
            due=len(due),
            missing=len(due) - on_grid,
            duplicate=len(stamps) - len(found),
            out_of_order=backward,
            stray=len(found) - on_grid,
            first_missing_ns=next((stamp for stamp in due if stamp not in found), 0),
        )

    def _end_ns(self, topic: str, last_ns: int) -> int:
        command = self._types[topic] in COMMAND_TYPES
        return last_ns - self._period_ns if command else last_ns


def describe(episode: int, verdicts: Iterable[TopicVerdict]) -> list[str]:
    """Return one line for each topic of an episode that is not complete."""
    return [f'episode {episode}, {verdict}' for verdict in verdicts if not verdict.complete]
