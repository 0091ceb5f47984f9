# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Carries the first episodes of a recording that was cut over to the recording that goes on.

They are recorded once more from the old file, message by message, so that the new bag says of
them what it would have said had it been there.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import islice
from pathlib import Path
from typing import Any

from mcap.records import Channel, McapRecord, Message, Schema
from mcap_ros2.decoder import DecoderFactory

from hexapod_doe.bags.cuts import cuts_of, is_own
from hexapod_doe.bags.recording import Recording
from hexapod_doe.bags.rosbag2 import Topic
from hexapod_doe.bags.run_bag import EPISODE_RESULT, RESUMED, is_evaluation
from hexapod_doe.bags.salvage import topic_of, whole_records
from hexapod_doe.bags.schema import definition
from hexapod_doe.errors import BagError


@dataclass(frozen=True)
class CutEpisode:
    """One whole episode of an old file."""

    result: Any
    """The decoded EpisodeResult."""
    topic: Topic
    data: bytes
    """The result as it came."""
    samples: tuple[tuple[str, bytes], ...]
    """Topic and message of a sampled episode, in their order."""
    sampled_topics: tuple[Topic, ...]

    @property
    def end_ns(self) -> int:
        """Stamp of the episode's last sample."""
        stamp = self.result.header.stamp
        return int(stamp.sec) * 1_000_000_000 + int(stamp.nanosec)


def open_recording(
    run_id: str,
    bag: Path,
    metadata: Mapping[str, str],
    period_ns: int,
    keep: int,
    result_topic: str,
) -> tuple[Recording, int, int]:
    """Open the bag of a run, with its first episodes in it if an earlier recording has them.

    Args:
        run_id: of the run.
        bag: directory that the bag will have when it is complete.
        metadata: stored in the bag at once.
        period_ns: control period; 0 where samples keep no common grid.
        keep: episodes to carry over, all of them or none.
        result_topic: where the results of this recording come from.

    Returns:
        The recording, how many episodes are in it, and the stamp at their end, ns.

    Raises:
        BagError: the bag cannot be opened or written.
    """
    cut = find_cut(bag, run_id, keep, metadata) if keep else None
    if cut is None:
        recording = Recording(run_id, bag, metadata, period_ns)
        recording.forget_cuts()
        return recording, 0, 0
    recording = Recording(run_id, bag, {**metadata, RESUMED: str(keep)}, period_ns)
    return recording, keep, carry_over(recording, cut, keep, result_topic)


def find_cut(
    bag: Path, run_id: str, episodes: int, metadata: Mapping[str, str] | None = None
) -> Path | None:
    """Return the newest `<bag>.cut_<n>` that holds the first so many episodes of a run, if any.

    One of another version, whose messages have other fields, cannot go on: a topic of a bag has
    one definition.

    Args:
        bag: directory that the run's bag will have.
        run_id: of the run.
        episodes: how many.
        metadata: what else is known of the run; one of another specification is none of it.
    """
    said = {**(metadata or {}), 'run_id': run_id}
    for cut in cuts_of(bag):
        if not is_own(cut, bag, said):
            continue
        found = list(islice(cut_episodes(cut / f'{bag.name}_0.mcap'), episodes))
        numbers = [e.result.episode for e in found if e.result.run_id == run_id]
        if any(e.topic.definition != definition(EPISODE_RESULT) for e in found):
            continue
        if len(numbers) == episodes and numbers == list(range(len(numbers))):
            return cut
    return None


def carry_over(recording: Recording, cut: Path, episodes: int, result_topic: str) -> int:
    """Record the first episodes of a cut bag once more; return the stamp at their end, ns.

    Args:
        recording: that goes on; still empty.
        cut: as `find_cut` returned it.
        episodes: how many.
        result_topic: where the results of this recording come from. Its namespace takes the place
            of the old one, as another worker may have begun the run.

    Raises:
        BagError: the disk refuses.
    """
    end_ns = 0
    file = cut / f'{recording.bag.name}_0.mcap'
    for episode in islice(cut_episodes(file), episodes):
        names = _Renaming(episode.topic.name, result_topic)
        if episode.samples:
            topics = [names.topic(topic) for topic in episode.sampled_topics]
            recording.begin_sample(episode.result.episode, topics)
            for name, data in episode.samples:
                recording.add_sample(names.name(name), data)
            recording.end_sample(episode.end_ns)
        recording.add_result(
            names.topic(episode.topic),
            episode.data,
            episode.result.episode,
            episode.result.steps,
        )
        end_ns = episode.end_ns
    recording.secure()
    recording.forget_cuts(keep=cut)
    return end_ns


def cut_episodes(file: Path) -> Iterator[CutEpisode]:
    """Yield the whole episodes of an MCAP file, up to where it is cut or damaged."""
    reader = _EpisodeReader()
    try:
        stream = file.open('rb')
    except OSError:  # nothing was written before the cut
        return
    with stream:
        for record in whole_records(stream):
            if (episode := reader.take(record)) is not None:
                yield episode


class _EpisodeReader:
    """Gathers records until an episode's result closes it."""

    def __init__(self) -> None:
        self._schemas: dict[int, Schema] = {}
        self._channels: dict[int, Channel] = {}
        self._samples: list[tuple[str, bytes]] = []
        self._decoders = DecoderFactory()

    def take(self, record: McapRecord) -> CutEpisode | None:
        """Return the episode that ends with this record, if one does."""
        match record:
            case Schema():
                self._schemas[record.id] = record
            case Channel():
                self._channels[record.id] = record
            case Message():
                return self._take_message(record)
        return None

    def _take_message(self, message: Message) -> CutEpisode | None:
        channel = self._channels[message.channel_id]
        schema = self._schemas[channel.schema_id]
        if is_evaluation(channel.topic):  # it follows the last episode, and is begun again
            return None
        if schema.name != EPISODE_RESULT:
            self._samples.append((channel.topic, message.data))
            return None
        samples, self._samples = self._samples, []
        decode = self._decoders.decoder_for(channel.message_encoding, schema)
        if decode is None:
            raise BagError(f'topic {channel.topic}: encoding {channel.message_encoding!r}')
        topic = topic_of(channel, schema)
        others = [t for t in self._topics() if t.type_name != EPISODE_RESULT]
        return CutEpisode(decode(message.data), topic, message.data, tuple(samples), tuple(others))

    def _topics(self) -> list[Topic]:
        return [topic_of(c, self._schemas[c.schema_id]) for c in self._channels.values()]


class _Renaming:
    """Moves topics from the namespace of one worker to that of another."""

    def __init__(self, old_result_topic: str, new_result_topic: str) -> None:
        end = new_result_topic.rsplit('/', 1)[1]
        self._old = old_result_topic.removesuffix(end)
        self._new = new_result_topic.removesuffix(end)

    def name(self, topic: str) -> str:
        """Return the new name of a topic; one outside the namespace keeps its name."""
        inside = topic.startswith(self._old)
        return self._new + topic.removeprefix(self._old) if inside else topic

    def topic(self, topic: Topic) -> Topic:
        """Return the topic under its new name."""
        return replace(topic, name=self.name(topic.name))
