# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Whether a topic is there: publishers, type, quality of service, messages."""

from collections.abc import Iterator

from hexapod_agent.contract.finding import Finding
from hexapod_agent.contract.subject import Subject

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
