# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Runs every check of the sensor contract on what was heard of a set's topics."""

from collections.abc import Callable, Iterator

from hexapod_agent.contract import (
    inertial,
    plausibility,
    shape,
    timing,
)
from hexapod_agent.contract.evidence import Evidence
from hexapod_agent.contract.finding import Finding, Subject
from hexapod_agent.contract.limits import Limits
from hexapod_agent.contract.report import SensorReport, TopicRow, topic_row
from hexapod_agent.contract.timing import Clock
from hexapod_agent.specification.observation import ObservationSpec

_READABLE: tuple[Callable[[Subject], Iterator[Finding]], ...] = (
    shape.check_shape,
    inertial.check_given,
    shape.check_finite,
)
_ON_NUMBERS: tuple[Callable[[Subject], Iterator[Finding]], ...] = (
    plausibility.check_motion,
    plausibility.check_units,
    plausibility.check_range,
    plausibility.check_contacts,
    inertial.check_gravity,
    inertial.check_orientation,
)


def check_sensors(
    spec: ObservationSpec, evidence: Evidence, limits: Limits | None = None, reliable: bool = False
) -> SensorReport:
    """Check all topics of a set.

    Args:
        spec: the set.
        evidence: what was heard of its topics; none may be left out.
        limits: tolerances; None for the usual ones.
        reliable: whether the agent will subscribe reliably, as in lock-step.
    """
    limits = limits or Limits()
    clocks = [
        timing.clock_of(evidence.topics[channel.topics[0]].samples)
        for channel in spec.channels
        if channel.topics and evidence.topics[channel.topics[0]].samples
    ]
    rows: list[TopicRow] = []
    findings: list[Finding] = []
    for channel in spec.channels:
        subjects = [Subject(channel, t, evidence, limits, reliable) for t in channel.topics]
        sound = True
        for subject in subjects:
            found, readable = _check_topic(subject, clocks)
            findings += found
            sound &= readable
            rows.append(topic_row(subject, clocks, found))
        if subjects and sound:
            findings += plausibility.check_weight(subjects)
    return SensorReport(spec.letters, tuple(rows), tuple(findings))


def _check_topic(subject: Subject, clocks: list[Clock]) -> tuple[list[Finding], bool]:
    """Check one topic; return the findings, and whether its numbers could be read."""
    found = list(timing.check_publishers(subject))
    if any(finding.kind == timing.MANY_PUBLISHERS for finding in found):
        return found, False  # what two of them say by turns is no fault of either
    if not subject.samples:
        return found or list(timing.check_messages(subject)), False
    found += timing.check_messages(subject)
    stamps = list(timing.check_stamps(subject))
    found += stamps or timing.check_lag(subject, clocks)
    found += timing.check_pauses(subject, clocks)
    found += timing.check_rate(subject)
    found += shape.check_frame(subject)
    for readable in _READABLE:
        unreadable = list(readable(subject))
        if unreadable:
            return found + unreadable, False
    for check in _ON_NUMBERS:
        # The first check that sees a fault knows it best: motion tells rpm from degrees/s.
        seen = {(finding.kind, finding.field) for finding in found}
        found += (new for new in check(subject) if (new.kind, new.field) not in seen)
    return found, True
