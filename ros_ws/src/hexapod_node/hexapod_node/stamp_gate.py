# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Decides by stamp which messages belong to the control period that is due."""

from collections.abc import Iterable
from dataclasses import dataclass, fields
from typing import Any

# Two are under way in lock-step: more come of wrong stamps, which may not fill the memory.
_MOST_PERIODS = 64


@dataclass
class LockStepCounts:
    """Departures from lock-step. A healthy run counts none."""

    late: int = 0
    """Samples of a period that is over."""
    missing: int = 0
    """Samples that had not come when the wait ended."""
    duplicate: int = 0
    """Further samples of a topic and period; the first one counts."""
    out_of_order: int = 0
    """Samples of a period that has not begun; they wait for their turn."""

    def reset(self) -> None:
        """Set every count to zero."""
        for field in fields(self):
            setattr(self, field.name, 0)


class DuePeriod:
    """Admits the one message of the period that is due and counts all others."""

    def __init__(self, period_ns: int) -> None:
        self.period_ns = period_ns
        self.counts = LockStepCounts()
        self.stamp_ns: int | None = None

    def start(self, stamp_ns: int) -> None:
        """Expect the period that begins at the stamp."""
        self.stamp_ns = stamp_ns

    def stop(self) -> None:
        """Expect nothing."""
        self.stamp_ns = None

    def admit(self, stamp_ns: int) -> bool:
        """Return whether the message is due; count it otherwise."""
        due = self.stamp_ns
        if stamp_ns == due:
            return True
        if due is None or stamp_ns > due:
            self.counts.out_of_order += 1
        elif stamp_ns == due - self.period_ns:
            self.counts.duplicate += 1
        else:
            self.counts.late += 1
        return False


class StampGate:
    """Gathers one message per topic for the period that is expected.

    Until `start` names the first period, whatever comes is kept: the sim may publish the start of
    an episode before its answer to the reset has been read.
    """

    def __init__(self, topics: Iterable[str], period_ns: int) -> None:
        self.topics = tuple(topics)
        self.period_ns = period_ns
        self.counts = LockStepCounts()
        self.expected_ns: int | None = None
        self._waiting: dict[int, dict[str, Any]] = {}

    def stop(self) -> None:
        """Forget the period that was expected; the next ones are kept until `start`."""
        self.expected_ns = None
        self._waiting.clear()

    def start(self, stamp_ns: int) -> None:
        """Expect the period that begins at the stamp, and drop what is older."""
        self.expected_ns = stamp_ns
        self._waiting = {ns: had for ns, had in self._waiting.items() if ns >= stamp_ns}

    def offer(self, topic: str, stamp_ns: int, message: Any) -> bool:
        """Take a message; return whether the expected period is now complete.

        Of periods that have not begun, the earliest few wait for their turn.
        """
        expected = self.expected_ns
        if expected is not None and stamp_ns < expected:
            self.counts.late += 1
            return False
        had = self._waiting.setdefault(stamp_ns, {})
        if topic in had:
            self.counts.duplicate += 1
            return False
        if expected is not None and stamp_ns > expected:
            self.counts.out_of_order += 1
        had[topic] = message
        if len(self._waiting) > _MOST_PERIODS:
            self.counts.late += len(self._waiting.pop(self._dispensable()))
        return stamp_ns == expected and len(had) == len(self.topics)

    def _dispensable(self) -> int:
        """Return the stamp to forget: the last, or, before `start`, the one that came first."""
        return next(iter(self._waiting)) if self.expected_ns is None else max(self._waiting)

    @property
    def complete(self) -> bool:
        """Whether every topic has delivered the expected period."""
        if self.expected_ns is None:
            return False
        return len(self._waiting.get(self.expected_ns, ())) == len(self.topics)

    def take(self) -> dict[str, Any]:
        """Return the complete period, by topic, and expect the next one."""
        assert self.expected_ns is not None
        messages = self._waiting.pop(self.expected_ns)
        self.expected_ns += self.period_ns
        return messages

    def absent(self) -> list[str]:
        """Return the topics that the expected period still lacks."""
        had = self._waiting.get(self.expected_ns, {}) if self.expected_ns is not None else {}
        return [topic for topic in self.topics if topic not in had]
