# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What the page plots of each channel of the sensor table: topics, numbers and their names."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from hexapod_sim.channel import Channel, Field
from hexapod_sim.joint_names import by_joint
from hexapod_sim.message_fields import read
from hexapod_sim.robot import JOINTS, LEGS
from hexapod_sim.sensor_table import CHANNELS

JOINT_STATES, LINE_OFFSET = 'joint_states', 'line_offset'
ORIENTATION = 'imu/data'


@dataclass(frozen=True)
class Signal:
    """Numbers of one topic, those of the first field that an agent observes.

    Attributes:
        topic: Relative name.
        channel: Row of the sensor table.
        field: Which numbers.
        labels: What each number is.
    """

    topic: str
    channel: Channel
    field: Field
    labels: tuple[str, ...]

    def read(self, message: Any) -> list[float]:
        """Return the numbers of a message.

        Raises:
            ValueError: a joint is missing, or names and numbers are not as many.
        """
        if self.channel.has_joints:
            values = getattr(message, self.field.path)
            return by_joint(message.name, values, self.field.path).tolist()
        return [float(value) for value in read(message, self.field.path)]


def _signals() -> Iterator[Signal]:
    for channel in CHANNELS:
        if channel.is_measured or channel.source == 'cpg':
            field = channel.observed[0]
            for topic in channel.topics:
                yield Signal(topic, channel, field, _labels(channel, field))


def _labels(channel: Channel, field: Field) -> tuple[str, ...]:
    if channel.has_joints:
        return JOINTS
    if field.size == len(LEGS):
        return LEGS
    return tuple('xyzw'[: field.size]) if field.size > 1 else (channel.name,)


SIGNALS: dict[str, Signal] = {signal.topic: signal for signal in _signals()}
"""By topic."""


def panels() -> list[dict[str, Any]]:
    """Return one entry for each plot of sensors, as the page takes it."""
    found: dict[str, dict[str, Any]] = {}
    for topic, signal in SIGNALS.items():
        channel = signal.channel
        panel = found.setdefault(
            channel.key,
            {'name': channel.name, 'letter': channel.letter, 'unit': signal.field.unit,
             'topics': [], 'labels': []},
        )  # fmt: skip
        panel['topics'].append(topic)
        prefix = f'{topic.rpartition("/")[2]} ' if len(channel.topics) > 1 else ''
        panel['labels'].append([f'{prefix}{label}' for label in signal.labels])
    return list(found.values())
