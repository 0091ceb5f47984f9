# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Whether a topic is there and keeps time: publishers, type, stamps, rate, in step with others."""

from collections.abc import Iterator

import numpy as np
from hexapod_sim.robot import CONTROL_PERIOD_NS
from numpy.typing import NDArray

from hexapod_agent.contract.evidence import Sample
from hexapod_agent.contract.finding import Finding, Subject

MANY_PUBLISHERS = 'many_publishers'


def check_publishers(subject: Subject) -> Iterator[Finding]:
    """Check that one publisher offers the type, with a quality of service that we can have."""
    offers = subject.heard.offers
    if not offers:
        yield subject.finding(
            'missing',
            'topic',
            'is not there',
            f'a publisher of {subject.channel.message_type}',
            f'start what publishes it (device: {subject.channel.device}), or remap '
            f"'{subject.topic}' to its topic",
        )
        return
    if len(offers) > 1:
        names = ', '.join(offer.publisher for offer in offers if offer.publisher)
        yield subject.finding(
            MANY_PUBLISHERS,
            'topic',
            f'has {len(offers)} publishers{f" ({names})" if names else " by turns"}',
            'one',
            'stop all of them but one, or give each a topic of its own and remap the agent to the '
            'one that it should hear',
        )
    yield from _check_types(subject)
    yield from _check_qos(subject)


def check_messages(subject: Subject) -> Iterator[Finding]:
    """Check that messages came, and came until the end."""
    if not subject.samples:
        yield subject.finding(
            'stopped',
            'topic',
            'brought no message',
            'one per control period',
            'see whether the device is powered and its driver runs without errors',
        )
        return
    silent_s = (subject.evidence.end_ns - subject.samples[-1].arrival_ns) * 1e-9
    if silent_s > subject.limits.silence:
        yield subject.finding(
            'stopped',
            'topic',
            f'is silent since {silent_s:.2f} s',
            f'a message at least every {subject.limits.silence:g} s',
            'see whether the device is powered and its driver runs without errors',
        )


def _check_types(subject: Subject) -> Iterator[Finding]:
    wanted = subject.channel.message_type
    for found in sorted({offer.message_type for offer in subject.heard.offers} - {wanted}):
        yield subject.finding(
            'wrong_type',
            'topic',
            f'is of type {found}',
            wanted,
            f'let the driver publish {wanted}, or put a converter between',
        )


def _check_qos(subject: Subject) -> Iterator[Finding]:
    """A reliable subscription gets nothing from a best-effort publisher; all else matches."""
    if subject.reliable and not all(offer.reliable for offer in subject.heard.offers):
        yield subject.finding(
            'qos_mismatch',
            'qos.reliability',
            'is offered as best effort',
            'reliable, which the agent asks for in lock-step',
            'run the agent with sync:=realtime, or let the driver publish reliably',
        )


_STAMP = 'header.stamp'
_RATE_HZ = 1e9 / CONTROL_PERIOD_NS
_STAMPING = 'let the driver stamp each sample with the time of its measurement, on the ROS clock'

Clock = tuple[NDArray[np.int64], NDArray[np.int64]]
"""Arrivals and stamps of one channel [ns]."""


def check_stamps(subject: Subject) -> Iterator[Finding]:
    """Check that stamps are set and strictly increasing."""
    stamps = stamps_of(subject.samples)
    if not stamps.any():
        if len(stamps) > 1:
            yield subject.finding(
                'stale_stamps', _STAMP, 'is never set', 'the time of measurement', _STAMPING
            )
        return
    steps = np.diff(stamps)
    if len(steps) and not steps.any():
        yield subject.finding(
            'stale_stamps', _STAMP, 'stands still', 'a later one in every message', _STAMPING
        )
    elif (steps <= 0).any():
        back, same = int((steps < 0).sum()), int((steps == 0).sum())
        yield subject.finding(
            'stale_stamps',
            _STAMP,
            f'jumps back {back} times and repeats {same} times in {len(stamps)} messages',
            'a later one in every message',
            f'{_STAMPING}; see that one driver alone publishes the topic',
        )


def check_lag(subject: Subject, clocks: list[Clock]) -> Iterator[Finding]:
    """Check that the stamps are as late as those of the other channels."""
    lag = median_lag_s(subject.samples, clocks)
    longest = subject.limits.age(subject.topic)
    if abs(lag) <= longest:
        return
    side = 'behind' if lag > 0.0 else 'ahead of'
    yield subject.finding(
        'stale_stamps',
        _STAMP,
        f'is {abs(lag):.3f} s {side} the other channels',
        f'at most {longest:g} s',
        'synchronise the clocks (NTP, PTP), or shorten the delay of the driver'
        if lag > 0.0
        else 'synchronise the clocks (NTP, PTP)',
    )


def check_pauses(subject: Subject, clocks: list[Clock]) -> Iterator[Finding]:
    """Check that the topic does not pause while the other channels go on."""
    longest = subject.limits.silence
    pauses = gaps_s(clock_of(subject.samples))
    pauses = pauses[pauses > longest]
    # A robot that rests, or a bag of some episodes of many, pauses on all channels.
    usual = np.median([(gaps_s(clock) > longest).sum() for clock in clocks])
    if len(pauses) > usual:
        yield subject.finding(
            'pauses',
            'rate',
            f'has {len(pauses)} pauses of up to {pauses.max():.2f} s',
            f'a message at least every {longest:g} s',
            'see whether the device or its bus resets, or its driver blocks',
        )


def check_rate(subject: Subject) -> Iterator[Finding]:
    """Check the time between samples against the control period, pauses apart."""
    gaps = gaps_s(clock_of(subject.samples))
    gaps = gaps[gaps <= max(subject.limits.silence, np.median(gaps))] if len(gaps) else gaps
    if not len(gaps):
        return
    rate, usual = 1.0 / gaps.mean(), float(np.median(gaps))
    longest = subject.limits.age(subject.topic)
    if usual > longest:
        yield subject.finding(
            'slow',
            'rate',
            f'is {rate:.1f} Hz',
            f'{_RATE_HZ:g} Hz, and not under {1.0 / longest:g} Hz',
            "raise the driver's rate",
        )
    elif rate < subject.limits.least_rate * _RATE_HZ:
        yield subject.finding(
            'slow',
            'rate',
            f'is {rate:.1f} Hz',
            f'{_RATE_HZ:g} Hz, one sample per control period',
            "raise the driver's rate; the agent sees older values than it was trained with",
            'warning',
        )


def stamps_of(samples: tuple[Sample, ...]) -> NDArray[np.int64]:
    """Return the stamps [ns]."""
    return np.array([sample.stamp_ns for sample in samples], dtype=np.int64)


def clock_of(samples: tuple[Sample, ...]) -> Clock:
    """Return the arrivals and stamps of a channel."""
    arrivals = np.array([sample.arrival_ns for sample in samples], dtype=np.int64)
    return arrivals, stamps_of(samples)


def gaps_s(clock: Clock) -> NDArray[np.float64]:
    """Return the times between samples [s], by stamp, or by arrival where stamps are no clock.

    Stamps tell the rate of a driver also in simulated time and on a machine under load.
    """
    arrivals, stamps = clock
    steps = np.diff(stamps)
    return (steps if (steps > 0).all() else np.diff(arrivals)) * 1e-9


def median_lag_s(samples: tuple[Sample, ...], clocks: list[Clock]) -> float:
    """Return how far the stamps lie behind the other channels' when they arrive [s].

    The time at an arrival is the median of the channels' stamps, between two samples on a line. It
    needs no common clock with the drivers: simulated time, a bag and wall time are alike.
    """
    arrivals, stamps = clock_of(samples)
    began, first = arrivals[0], stamps[0]
    stamped = [
        np.interp((arrivals - began) * 1e-9, (came - began) * 1e-9, (stamp - first) * 1e-9)
        for came, stamp in clocks
    ]
    return float(np.median(np.median(stamped, axis=0) - (stamps - first) * 1e-9))
