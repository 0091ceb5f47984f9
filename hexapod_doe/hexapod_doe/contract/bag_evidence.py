# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What a bag holds of the sensor topics, for the sensor contract."""

from collections.abc import Mapping, Sequence
from itertools import pairwise
from pathlib import Path

from hexapod_agent.contract.evidence import (
    Evidence,
    Offer,
    Sample,
    TopicEvidence,
    checked_paths,
    sample,
)
from hexapod_agent.specification.observation import ObservationSpec
from hexapod_sim.channel import Channel

from hexapod_doe.bags.bag_file import BagFile, several
from hexapod_doe.contract.check_options import NAMESPACE
from hexapod_doe.errors import BagError

# A driver that was started anew takes over once or twice; two that run take turns all the time.
_FEWEST_TURNS = 4
_SHARE_OF_TURNS = 0.1


def bag_evidence(path: Path, spec: ObservationSpec, remaps: Mapping[str, str]) -> Evidence:
    """Read the topics of a set from a bag; recorded times stand for the arrivals.

    Args:
        path: directory of the bag, or one of its files.
        spec: the set.
        remaps: topics of the bag by relative topic of the sensor table, where they differ, and the
            namespace of the robot by `__ns`. Without a namespace, a name without a leading slash
            may be the end of a topic's.

    Raises:
        BagError: it cannot be read, a name that was given is not in it, or one that was not given
            may mean several topics.
    """
    bag = BagFile(path)
    names = _names(bag, spec, remaps)
    topics = {
        topic: _topic_evidence(bag, channel, topic, names[topic])
        for channel in spec.channels
        for topic in channel.topics
    }
    ends = [heard.samples[-1].arrival_ns for heard in topics.values() if heard.samples]
    return Evidence(topics, max(ends, default=bag.start_ns))


def _names(
    bag: BagFile, spec: ObservationSpec, remaps: Mapping[str, str]
) -> dict[str, str | None]:
    """Return the topics of the bag by those of the set, None where it has none.

    Raises:
        BagError: a name that was given leads to none, or one that was not leads to several.
    """
    namespace = remaps.get(NAMESPACE)
    names = {topic: _name(bag, topic, remaps.get(topic), namespace) for topic in spec.topics}
    if namespace is not None and not any(names.values()):
        first = next(iter(names))
        roots = ', '.join(name.removesuffix(f'/{first}') or '/' for name in bag.found(first))
        raise BagError(
            f'bag {bag.path}: no topic of the set in {namespace}, expected {roots or "none"}'
        )
    return names


def _name(bag: BagFile, topic: str, remapped: str | None, namespace: str | None) -> str | None:
    wanted = remapped or topic
    if namespace is not None and not wanted.startswith('/'):
        wanted = f'/{namespace.strip("/")}/{wanted}'.replace('//', '/')
    found = bag.found(wanted)
    if len(found) > 1:
        root = found[0].removesuffix(f'/{wanted}') or '/'
        raise BagError(
            f'bag {bag.path}: {several(wanted, found)}; choose one: '
            f'-r {NAMESPACE}:={root} for all topics, or -r {topic}:={found[0]} for this one'
        )
    if not found and remapped is not None:
        bag.topic(wanted)  # raises, with the topics that there are
    return found[0] if found else None


def _topic_evidence(bag: BagFile, channel: Channel, topic: str, name: str | None) -> TopicEvidence:
    if name is None:
        return TopicEvidence(topic)
    profiles = bag.qos[name]
    reliable = all(profile.reliability == 'reliable' for profile in profiles)
    types = bag.types_of(name)
    offers = tuple(Offer('', found, reliable) for found in types)
    if types != [channel.message_type]:
        return TopicEvidence(name, offers)
    paths = checked_paths(channel)
    try:
        samples = tuple(sample(message, paths, time_ns) for time_ns, message in bag.decoded(name))
    except AttributeError as error:
        raise BagError(
            f'bag {bag.path}: {name}: {types[0]} as the bag defines it is not the one that is '
            f'known here: {error}'
        ) from error
    # Several profiles may be of one publisher that came and went: only the messages can tell.
    if _taken_in_turns(samples) or (len(profiles) > 1 and _disorder(samples)):
        offers *= 2
    return TopicEvidence(name, offers, samples)


def _taken_in_turns(samples: Sequence[Sample]) -> bool:
    """Whether messages of different makers alternate: in frame, joint names or lengths."""
    makers = [
        (each.frame, each.names, tuple(values.size for values in each.values.values()))
        for each in samples
    ]
    turns = sum(one != other for one, other in pairwise(makers))
    return turns >= _FEWEST_TURNS and turns > _SHARE_OF_TURNS * len(samples)


def _disorder(samples: Sequence[Sample]) -> bool:
    """Whether stamps repeat or go back often."""
    steps = sum(later.stamp_ns <= earlier.stamp_ns for earlier, later in pairwise(samples))
    return steps >= _FEWEST_TURNS and steps > _SHARE_OF_TURNS * len(samples)
