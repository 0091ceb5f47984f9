# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What one check looks at: a topic of a channel, what was heard of it, and the tolerances."""

from dataclasses import dataclass

import numpy as np
from hexapod_sim.channel import Channel
from hexapod_sim.joint_names import joint_order
from numpy.typing import NDArray

from hexapod_agent.contract.evidence import Evidence, Sample, TopicEvidence
from hexapod_agent.contract.finding import Finding, Level
from hexapod_agent.contract.limits import Limits


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
