# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What one check looks at, and what it says: fault, field, what was expected, and the cure."""

from dataclasses import asdict, dataclass
from typing import Literal

import numpy as np
from hexapod_sim.channel import Channel
from hexapod_sim.joint_names import joint_order
from numpy.typing import NDArray

from hexapod_agent.contract.evidence import Evidence, Sample, TopicEvidence
from hexapod_agent.contract.limits import Limits

Level = Literal['fault', 'warning', 'note']
"""A fault refuses the sensor, a warning does not; a note says what could not be judged."""


@dataclass(frozen=True)
class Finding:
    """One departure from the contract."""

    kind: str
    """Its class, for programs: 'stopped', 'wrong_unit', ..."""
    channel: str
    """Name in the sensor table."""
    topic: str
    """Name on the graph or in the bag."""
    field: str
    """Of the message, such as 'header.frame_id'."""
    found: str
    """What it is, to be read after the field."""
    expected: str
    """What it should be."""
    cure: str
    """What to do about it."""
    level: Level = 'fault'

    def __str__(self) -> str:
        return (
            f'{self.channel}: {self.topic}: {self.field} {self.found}, '
            f'expected {self.expected}; cure: {self.cure}'
        )

    def as_dict(self) -> dict[str, str]:
        """Return it for JSON."""
        return asdict(self)


@dataclass(frozen=True)
class Subject:
    """A topic under check."""

    channel: Channel
    topic: str
    """Its relative name in the sensor table."""
    evidence: Evidence
    limits: Limits
    reliable: bool
    """Whether the agent asks for lost messages again."""

    @property
    def heard(self) -> TopicEvidence:
        """What was heard of it."""
        return self.evidence.topics[self.topic]

    @property
    def samples(self) -> tuple[Sample, ...]:
        """Its samples."""
        return self.heard.samples

    def stack(self, path: str) -> NDArray[np.float64]:
        """Return the numbers of a field (samples, size), joints in our order.

        Raises:
            ValueError: samples differ in length, or a joint is missing.
        """
        if not self.channel.has_joints:
            return np.stack([sample.values[path] for sample in self.samples])
        rows = []
        for sample in self.samples:
            order, values = joint_order(sample.names), sample.values[path]
            rows.append(values if order is None else values[order])
        return np.stack(rows)

    def finding(
        self,
        kind: str,
        field: str,
        found: str,
        expected: str,
        cure: str,
        level: Level = 'fault',
    ) -> Finding:
        """Return a finding on this topic."""
        topic = self.heard.topic
        return Finding(kind, self.channel.name, topic, field, found, expected, cure, level)
