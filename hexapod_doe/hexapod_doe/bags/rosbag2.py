# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The layout of a rosbag2 directory: names of its files and the content of metadata.yaml.

Version 9 of the layout, as rosbag2 of ROS 2 Jazzy writes it.
"""

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

METADATA_FILE = 'metadata.yaml'
ROOT_KEY = 'rosbag2_bagfile_information'
VERSION = 9
PARTIAL_SUFFIX = '.partial'
"""What a bag's name ends with until it is whole."""
_UNFINISHED = re.compile(r'\.(partial|cut_\d+|salvaged)$')

# rmw's value for "no limit", as rosbag2 spells it: the most nanoseconds that int64 holds.
_INFINITE_NS = 2**63 - 1
_RMW_NAMES = {
    'history': {0: 'system_default', 1: 'keep_last', 2: 'keep_all', 3: 'unknown'},
    'reliability': {0: 'system_default', 1: 'reliable', 2: 'best_effort', 3: 'unknown'},
    'durability': {0: 'system_default', 1: 'transient_local', 2: 'volatile', 3: 'unknown'},
    'liveliness': {0: 'system_default', 1: 'automatic', 3: 'manual_by_topic', 4: 'unknown'},
}


@dataclass(frozen=True)
class OfferedQos:
    """What a publisher offered; policies by their names in rosbag2."""

    reliability: str = 'reliable'
    durability: str = 'volatile'
    history: str = 'keep_last'
    depth: int = 10
    liveliness: str = 'automatic'
    deadline_ns: int = _INFINITE_NS
    lifespan_ns: int = _INFINITE_NS
    liveliness_lease_ns: int = _INFINITE_NS

    def as_dict(self) -> dict[str, Any]:
        """Return the profile with the keys and in the order of metadata.yaml."""
        return {
            'history': self.history,
            'depth': self.depth,
            'reliability': self.reliability,
            'durability': self.durability,
            'deadline': _duration(self.deadline_ns),
            'lifespan': _duration(self.lifespan_ns),
            'liveliness': self.liveliness,
            'liveliness_lease_duration': _duration(self.liveliness_lease_ns),
            'avoid_ros_namespace_conventions': False,
        }


@dataclass(frozen=True)
class Topic:
    """A topic as a bag lists it."""

    name: str
    """Fully qualified."""
    type_name: str
    """Such as 'sensor_msgs/msg/Imu'."""
    qos: tuple[OfferedQos, ...] = (OfferedQos(),)
    """One profile per publisher."""
    definition: str = ''
    """Text of the type; '' to take that of the installed package."""
    type_hash: str = ''
    """RIHS01 hash of the type; '' to take the installed one."""


@dataclass
class Extent:
    """How much a bag holds, and of which time."""

    counts: dict[str, int]
    """Messages by topic."""
    messages: int = 0
    start_ns: int = 0
    end_ns: int = 0

    def add(self, topic: str, time_ns: int) -> None:
        """Count one message."""
        if self.messages == 0:
            self.start_ns = self.end_ns = time_ns
        self.start_ns = min(self.start_ns, time_ns)
        self.end_ns = max(self.end_ns, time_ns)
        self.messages += 1
        self.counts[topic] += 1


def partial_path(bag: Path) -> Path:
    """Return where a bag is written until it is whole."""
    return bag.with_name(bag.name + PARTIAL_SUFFIX)


def is_unfinished(path: Path) -> bool:
    """Whether a directory's name says that it is not a whole bag."""
    return bool(_UNFINISHED.search(path.name))


def information(file_name: str, topics: Iterable[Topic], extent: Extent) -> dict[str, Any]:
    """Return the bag's information, as it stands under ROOT_KEY in metadata.yaml.

    Args:
        file_name: the one MCAP file.
        topics: in the order of their channels, types with their hashes.
        extent: what was written.
    """
    start = {'nanoseconds_since_epoch': extent.start_ns}
    duration = {'nanoseconds': extent.end_ns - extent.start_ns}
    return {
        'version': VERSION,
        'storage_identifier': 'mcap',
        'duration': duration,
        'starting_time': start,
        'message_count': extent.messages,
        'topics_with_message_count': [
            {
                'topic_metadata': {
                    'name': topic.name,
                    'type': topic.type_name,
                    'serialization_format': 'cdr',
                    'offered_qos_profiles': [profile.as_dict() for profile in topic.qos],
                    'type_description_hash': topic.type_hash,
                },
                'message_count': extent.counts[topic.name],
            }
            for topic in topics
        ],
        # Chunk compression is the MCAP file's own affair; these two are rosbag2's outer one.
        'compression_format': '',
        'compression_mode': '',
        'relative_file_paths': [file_name],
        'files': [
            {
                'path': file_name,
                'starting_time': start,
                'duration': duration,
                'message_count': extent.messages,
            }
        ],
        'custom_data': None,
        'ros_distro': 'jazzy',
    }


def qos_text(profiles: Sequence[OfferedQos]) -> str:
    """Return the profiles as a channel's metadata holds them, equal to those of metadata.yaml."""
    return to_yaml([profile.as_dict() for profile in profiles])


def offered_qos(profiles: str | Sequence[Mapping[str, Any]]) -> tuple[OfferedQos, ...]:
    """Return the profiles of a topic, as any version of rosbag2 wrote them.

    Up to version 8 they are a YAML text, and policies are the numbers of rmw/types.h.
    """
    if isinstance(profiles, str):
        profiles = yaml.safe_load(profiles) or []
    return tuple(_profile(entry) for entry in profiles)


def _profile(entry: Mapping[str, Any]) -> OfferedQos:
    named = {policy: _RMW_NAMES[policy].get(entry[policy], entry[policy]) for policy in _RMW_NAMES}
    return OfferedQos(
        **named,
        depth=entry['depth'],
        deadline_ns=_nanoseconds(entry['deadline']),
        lifespan_ns=_nanoseconds(entry['lifespan']),
        liveliness_lease_ns=_nanoseconds(entry['liveliness_lease_duration']),
    )


def to_yaml(value: Any) -> str:
    """Return YAML without anchors, which rosbag2 does not write either."""
    return yaml.dump(value, Dumper=_PlainDumper, sort_keys=False)


class _PlainDumper(yaml.SafeDumper):
    def ignore_aliases(self, data: Any) -> bool:
        return True


def _duration(nanoseconds: int) -> dict[str, int]:
    seconds, rest = divmod(nanoseconds, 1_000_000_000)
    return {'sec': seconds, 'nsec': rest}


def _nanoseconds(duration: Mapping[str, int]) -> int:
    return duration['sec'] * 1_000_000_000 + duration['nsec']
