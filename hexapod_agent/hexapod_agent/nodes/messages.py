# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Messages as what an agent observes, and what it reports as messages."""

from __future__ import annotations

from array import array
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from hexapod_interfaces.msg import EpisodeResult, StepOutcome
from hexapod_node.stamps import time_message
from hexapod_sim.channel import Channel, Field, Numbers
from hexapod_sim.joint_names import by_joint
from hexapod_sim.message_fields import read
from hexapod_sim.task import Outcome

if TYPE_CHECKING:
    from hexapod_node.stamp_gate import LockStepCounts

    from hexapod_agent.learning.summary import EpisodeSummary


def decode(channel: Channel, messages: Mapping[str, Any]) -> dict[str, Numbers]:
    """Return what a channel's messages say, by quantity, from those of all its topics.

    Joint arrays are matched by joint name: a driver may publish them in its own order, with
    further joints, and with a prefix before the names.

    Raises:
        ValueError: a joint is missing or an array is too short; the text names topic and field.
    """
    readings: dict[str, Numbers] = {}
    for field in channel.observed:
        parts = [_numbers(channel, topic, field, messages[topic]) for topic in channel.topics]
        numbers = parts[0] if len(parts) == 1 else np.array(parts)
        had = readings.get(field.reading)
        readings[field.reading] = numbers if had is None else np.concatenate((had, numbers))
    return channel.observe(readings)


def outcome_from_message(message: StepOutcome) -> Outcome:
    """Return what a control period earned."""
    return Outcome(
        step=message.step,
        reward=message.reward,
        terms=dict(zip(message.term_names, message.term_values, strict=True)),
        terminated=message.terminated,
        truncated=message.truncated,
        cause=message.cause,
    )


def summary_to_message(
    run_id: str, summary: EpisodeSummary, counts: LockStepCounts, stamp_ns: int
) -> EpisodeResult:
    """Return the result of an episode of a run, with the stamp of its last sample."""
    result = EpisodeResult(
        run_id=run_id,
        episode=summary.episode,
        steps=summary.steps,
        episode_return=summary.episode_return,
        average_return=summary.average_return,
        term_names=list(summary.terms),
        term_values=array('d', summary.terms.values()),
        metric_names=list(summary.metrics),
        metric_values=array('d', summary.metrics.values()),
        terminated=summary.terminated,
        cause=summary.cause,
        **vars(counts),
    )
    result.header.stamp = time_message(stamp_ns)
    return result


def _numbers(channel: Channel, topic: str, field: Field, message: Any) -> Numbers:
    if not channel.has_joints:
        return read(message, field.path)
    try:
        return by_joint(message.name, getattr(message, field.path), field.path)
    except ValueError as error:
        raise ValueError(f'{topic}: {error}') from error
