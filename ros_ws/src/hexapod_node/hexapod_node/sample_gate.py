# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Keeps the newest good sample of a topic for as long as it is young enough."""

from collections import Counter
from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any, Generic, TypeVar

from hexapod_node.invalid_message import fault_kind

Value = TypeVar('Value')

# Stamps of another machine, or of the end of a period, may lie a little ahead.
FUTURE_NS = 50_000_000
# A publisher numbers its samples. As many may be lost between two that come: at 1 kHz those of a
# stall that the default greatest age just allows.
_MOST_LOST = 128
_CONTEST_NS = 2_000_000_000


@dataclass
class SampleCounts:
    """What came. A healthy topic counts nothing but `received`."""

    received: int = 0
    """Samples of any kind."""
    stale: int = 0
    """Samples that were too old when they came."""
    future: int = 0
    """Samples stamped with a time that is yet to come."""
    out_of_order: int = 0
    """Samples older than the one before."""
    duplicate: int = 0
    """Samples stamped as the one before; the first one counts."""
    invalid: int = 0
    """Samples with contents that cannot be used."""
    other_publisher: int = 0
    """Samples of a further publisher; the first one is heard for as long as it speaks."""

    @property
    def faults(self) -> int:
        """Samples that were dropped."""
        return self.received - self.accepted

    @property
    def accepted(self) -> int:
        """Samples that became the newest one."""
        dropped = self.stale + self.future + self.out_of_order + self.duplicate + self.invalid
        return self.received - dropped - self.other_publisher


class SampleGate(Generic[Value]):
    """The newest sample of one topic.

    A bad sample is dropped, so that the last good one serves until it is too old.

    Attributes:
        counts: What came so far.
        kinds: Samples with contents that cannot be used, by the kind of their fault.
        reason: Why the last bad sample was dropped; empty if none was.
    """

    def __init__(self, topic: str, max_age_ns: int, decode: Callable[[Any], Value]) -> None:
        """Begin without a sample.

        Args:
            topic: Name for texts.
            max_age_ns: Greatest age at which a sample still counts.
            decode: Makes a value of a message; raises ValueError where it cannot, or
                InvalidMessageError to be counted by kind.
        """
        self.counts = SampleCounts()
        self.kinds: Counter[str] = Counter()
        self.reason = ''
        self._topic = topic
        self._max_age_ns = max_age_ns
        self._decode = decode
        self._stamp_ns: int | None = None
        self._value: Value | None = None
        self._sequence: int | None = None
        self._contested_ns: int | None = None

    def offer(self, message: Any, stamp_ns: int, now_ns: int, sequence: int | None = None) -> bool:
        """Take a message; return whether it is the newest sample now.

        Args:
            message: of the topic.
            stamp_ns: its stamp.
            now_ns: the time that the stamp is compared with.
            sequence: its number among those of its publisher; None where that is not known.
        """
        self.counts.received += 1
        reason = self._source_fault(sequence, now_ns) or self._timing_fault(stamp_ns, now_ns)
        if not reason:
            try:
                self._value = self._decode(message)
            except ValueError as error:
                self.counts.invalid += 1
                self.kinds[fault_kind(error)] += 1
                reason = str(error)
            else:
                self._stamp_ns = stamp_ns
                self._sequence = sequence
        self.reason = reason or self.reason
        return not reason

    def age_ns(self, now_ns: int) -> int | None:
        """Return the age of the newest sample; None if there was none yet."""
        return None if self._stamp_ns is None else now_ns - self._stamp_ns

    def value(self, now_ns: int) -> Value | None:
        """Return the newest sample's value; None if it is too old, or there was none yet."""
        return self._value if self._young(now_ns) else None

    def fault(self, now_ns: int) -> str:
        """Say why there is no value; '' if there is one."""
        if self._young(now_ns):
            return ''
        cause = f'; the last bad one: {self.reason}' if self.reason else ''
        age_ns = self.age_ns(now_ns)
        if age_ns is None:
            return f'{self._topic}: no good sample yet{cause}'
        return (
            f'{self._topic}: newest good sample is {age_ns * 1e-9:.3f} s old, expected at most '
            f'{self._max_age_ns * 1e-9:g} s{cause}'
        )

    def contest(self, now_ns: int) -> str:
        """Say that a further publisher was heard of late; '' if none was."""
        if self._contested_ns is None or not 0 <= now_ns - self._contested_ns < _CONTEST_NS:
            return ''
        return (
            f'{self._topic}: has more than one publisher, expected one; the first one is heard, '
            f'{self.counts.other_publisher} samples of others were dropped'
        )

    def shown_counts(self) -> dict[str, int]:
        """Return every count by name, for the diagnostics."""
        return asdict(self.counts) | dict(self.kinds)

    def _young(self, now_ns: int) -> bool:
        age_ns = self.age_ns(now_ns)
        return age_ns is not None and -FUTURE_NS <= age_ns <= self._max_age_ns

    def _source_fault(self, sequence: int | None, now_ns: int) -> str:
        """Count a sample that does not go on with the numbers of the one before, and say so.

        rclpy does not tell who published a sample. Whoever has been silent for longer than the
        greatest age is forgotten, and the next publisher with a good sample becomes the first.
        """
        had = self._sequence if self._young(now_ns) else None
        if sequence is None or had is None:
            return ''
        if had < sequence <= had + _MOST_LOST:
            self._sequence = sequence
            return ''
        self.counts.other_publisher += 1
        self._contested_ns = now_ns
        return self.contest(now_ns)

    def _timing_fault(self, stamp_ns: int, now_ns: int) -> str:
        """Count a sample whose stamp is at fault, and say what is wrong."""
        age_ns = now_ns - stamp_ns
        # A sample that is too old itself, as after a jump of the clock, holds nobody up.
        held_ns = self._stamp_ns if self._young(now_ns) else None
        if age_ns > self._max_age_ns:
            self.counts.stale += 1
            return f'{self._topic}: header.stamp is {age_ns * 1e-9:.3f} s old'
        if age_ns < -FUTURE_NS:
            self.counts.future += 1
            return f'{self._topic}: header.stamp is {-age_ns * 1e-9:.3f} s in the future'
        if held_ns is not None and stamp_ns < held_ns:
            self.counts.out_of_order += 1
            return f'{self._topic}: header.stamp went back by {(held_ns - stamp_ns) * 1e-9:.3f} s'
        if stamp_ns == held_ns:
            self.counts.duplicate += 1
            return f'{self._topic}: header.stamp is that of the sample before'
        return ''
