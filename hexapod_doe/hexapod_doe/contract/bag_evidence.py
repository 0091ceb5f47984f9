# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What a bag holds of the sensor topics, for the sensor contract."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from hexapod_agent.contract.evidence import Evidence, Offer, TopicEvidence, sample
from hexapod_agent.contract.fields import checked_paths
from hexapod_agent.observation import Channel, ObservationSpec

from hexapod_doe.bags.bag_file import BagFile
from hexapod_doe.errors import BagError


def bag_evidence(path: Path, spec: ObservationSpec, remaps: Mapping[str, str]) -> Evidence:
    """Read the topics of a set from a bag; recorded times stand for the arrivals.

    Args:
        path: directory of the bag.
        spec: the set.
        remaps: topics of the bag by relative topic of the sensor table, where they differ. A name
            without a leading slash may be the end of one.

    Raises:
        BagError: it cannot be read, or a name that was given is not in it.
    """
    bag = BagFile(path)
    topics = {
        topic: _topic_evidence(bag, channel, topic, remaps.get(topic))
        for channel in spec.channels
        for topic in channel.topics
    }
    ends = [heard.samples[-1].arrival_ns for heard in topics.values() if heard.samples]
    return Evidence(topics, max(ends, default=bag.start_ns))


def _topic_evidence(
    bag: BagFile, channel: Channel, topic: str, remapped: str | None
) -> TopicEvidence:
    try:
        name = bag.topic(remapped or topic)
    except BagError:
        if remapped is not None:
            raise
        return TopicEvidence(topic)
    found = bag.types[name]
    profiles = bag.qos[name]
    reliable = all(profile.reliability == 'reliable' for profile in profiles)
    # Several profiles may be of one publisher that came and went: a bag cannot tell.
    offers = (Offer('', found, reliable),)
    if found != channel.message_type:
        return TopicEvidence(name, offers)
    paths = checked_paths(channel)
    samples = tuple(sample(message, paths, time_ns) for time_ns, message in bag.decoded(name))
    return TopicEvidence(name, offers, samples)
