# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What a healthy robot's topics deliver, for tests to break in one place."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hexapod_agent.contract.check import check_sensors
from hexapod_agent.contract.evidence import Evidence, Offer, Sample, TopicEvidence
from hexapod_agent.contract.finding import Finding
from hexapod_agent.contract.limits import Limits
from hexapod_agent.contract.report import SensorReport
from hexapod_agent.specification.observation import ObservationSpec
from hexapod_sim.channel import Channel
from hexapod_sim.robot import CONTROL_PERIOD_NS, GRAVITY, JOINTS, NEUTRAL_POSE, TOTAL_MASS
from hexapod_sim.sensor_table import CHANNELS, LETTERS

SAMPLES = 80
START_NS = 5_000_000_000
SWING_RAD = 0.3
SWING_RAD_PER_S = 6.0  # angular frequency of a tripod gait of about 1 Hz


def healthy_values(channel: Channel, topic: str, seconds: float) -> dict[str, np.ndarray]:
    """Return a message's numbers while every joint swings about the standing pose.

    What is not told here, as of a sensor that was added, is observed as 0.
    """
    phase = SWING_RAD_PER_S * seconds
    leg = topic.removeprefix('foot_force/')
    values = {field.path: np.full(field.size, field.center) for field in channel.fields}
    values |= {
        'joint_states': {
            'position': NEUTRAL_POSE + SWING_RAD * np.sin(phase),
            'velocity': np.full(18, SWING_RAD * SWING_RAD_PER_S * np.cos(phase)),
        },
        'cpg/state': {'x': np.full(6, np.cos(phase)), 'y': np.full(6, np.sin(phase))},
        'line_offset': {'offset': np.array([0.3])},
        'joint_torques': {'effort': np.full(18, 0.5)},
        'body/twist': {'twist.linear': np.array([0.25, 0.0, 0.0])},
        'imu/data': {'orientation': np.array([0.0, 0.0, np.sin(0.2), np.cos(0.2)])},
        'imu/data_raw': {'angular_velocity': np.array([0.1, 0.0, 0.3])},
        'body/height': {
            'range': np.array([0.13]),
            'min_range': np.array([0.02]),
            'max_range': np.array([1.0]),
        },
        f'foot_force/{leg}': {'wrench.force': np.array([0.5, 0.0, TOTAL_MASS * GRAVITY / 6])},
        'foot_contacts': {'contact': np.array([1.0, 0.0, 1.0, 0.0, 1.0, 0.0])},
    }.get(topic, {})
    if topic.startswith('imu'):
        values |= {
            'linear_acceleration': np.array([0.2, -0.1, GRAVITY]),
            'linear_acceleration_covariance': np.zeros(9),
            'angular_velocity_covariance': np.zeros(9),
            'orientation_covariance': np.zeros(9),
        }
    return values


def healthy() -> Evidence:
    """Return two seconds of every topic."""
    topics = {}
    for channel in CHANNELS:
        for index, topic in enumerate(channel.topics):
            frame = channel.frames[index] if channel.frames else ''
            joints = channel.has_joints
            samples = tuple(
                Sample(
                    arrival_ns=START_NS + step * CONTROL_PERIOD_NS + 2_000_000,
                    stamp_ns=START_NS + step * CONTROL_PERIOD_NS,
                    frame=frame,
                    names=JOINTS if joints else (),
                    values=healthy_values(channel, topic, step * CONTROL_PERIOD_NS * 1e-9),
                )
                for step in range(SAMPLES)
            )
            offer = Offer('/driver', channel.message_type)
            topics[topic] = TopicEvidence(f'/robot/{topic}', (offer,), samples)
    return Evidence(topics, START_NS + SAMPLES * CONTROL_PERIOD_NS)


Change = Callable[[Sample], Sample]


class Robot:
    """A healthy robot in which a test breaks something."""

    def __init__(self) -> None:
        self.evidence = healthy()

    def change(self, topic: str, change: Callable[[TopicEvidence], TopicEvidence]) -> None:
        """Replace what was heard of a topic."""
        topics = dict(self.evidence.topics)
        topics[topic] = change(topics[topic])
        self.evidence = replace(self.evidence, topics=topics)

    def each(self, topic: str, change: Change) -> None:
        """Replace each sample of a topic."""
        self.change(topic, lambda had: replace(had, samples=tuple(map(change, had.samples))))

    def values(self, topic: str, path: str, change: Callable[[np.ndarray], np.ndarray]) -> None:
        """Replace the numbers of a field in each sample."""

        def changed(sample: Sample) -> Sample:
            return replace(
                sample, values={**sample.values, path: np.asarray(change(sample.values[path]))}
            )

        self.each(topic, changed)

    def report(
        self, limits: Limits | None = None, reliable: bool = False, letters: str = LETTERS
    ) -> SensorReport:
        """Check it."""
        return check_sensors(ObservationSpec(letters), self.evidence, limits, reliable)

    def fault(self, **options: object) -> Finding:
        """Check it, and return the one fault."""
        (fault,) = self.report(**options).faults
        return fault


@pytest.fixture
def robot() -> Robot:
    return Robot()
