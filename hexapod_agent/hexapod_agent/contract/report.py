# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The outcome of a check: one row per topic and every finding, for people and for programs."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

from hexapod_agent.contract.finding import Finding, Subject
from hexapod_agent.contract.timing import Clock, clock_of, gaps_s, median_lag_s


@dataclass(frozen=True)
class TopicRow:
    """What was measured of one topic."""

    letter: str
    """Factor of the experiment; empty for a channel that is always observed."""
    channel: str
    topic: str
    """Name on the graph or in the bag."""
    message_type: str
    """As offered; empty without a publisher."""
    messages: int
    """How many were heard."""
    rate: float | None
    """Mean, pauses and all [Hz]; None with fewer than two messages."""
    lag: float | None
    """Median of how far its stamps lie behind the other channels' [s]."""
    frame: str
    """Of its last header."""
    verdict: str
    """'pass', 'warning' or 'fault'."""


@dataclass(frozen=True)
class SensorReport:
    """What a set's sensors deliver, held against the sensor contract."""

    observations: str
    rows: tuple[TopicRow, ...]
    findings: tuple[Finding, ...]

    @property
    def faults(self) -> tuple[Finding, ...]:
        """What must be cured before the robot may walk."""
        return tuple(finding for finding in self.findings if finding.level == 'fault')

    @property
    def passed(self) -> bool:
        """Whether there is no fault."""
        return not self.faults

    @property
    def refusal(self) -> str:
        """One line per fault; empty if there is none."""
        return '\n'.join(map(str, self.faults))

    def as_dict(self) -> dict[str, Any]:
        """Return it for JSON."""
        return {
            'observations': self.observations,
            'passed': self.passed,
            'topics': [asdict(row) for row in self.rows],
            'findings': [finding.as_dict() for finding in self.findings],
        }


def topic_row(subject: Subject, clocks: list[Clock], findings: Sequence[Finding]) -> TopicRow:
    """Return the row of a topic."""
    heard, samples = subject.heard, subject.samples
    gaps = gaps_s(clock_of(samples))
    levels = {finding.level for finding in findings}
    return TopicRow(
        letter=subject.channel.letter,
        channel=subject.channel.name,
        topic=heard.topic,
        message_type=', '.join(sorted({offer.message_type for offer in heard.offers})),
        messages=len(samples),
        rate=float(1.0 / gaps.mean()) if gaps.size and gaps.mean() > 0.0 else None,
        lag=median_lag_s(samples, clocks) if samples else None,
        frame=samples[-1].frame if samples else '',
        verdict='fault' if 'fault' in levels else 'warning' if 'warning' in levels else 'pass',
    )
