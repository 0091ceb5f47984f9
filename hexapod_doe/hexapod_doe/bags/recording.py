# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The bag of one run while the run lasts: episode results throughout, all topics in samples.

Messages are logged, and marked as published, at their own simulated stamp and not at the wall
clock: two runs of one seed then give the same bag whatever machine they ran on, and a period is
the same instant on every topic. A type without a stamp is logged at the newest stamp so far.
"""

from collections.abc import Iterable, Mapping
from datetime import UTC, datetime
from pathlib import Path

from hexapod_doe.bags.bag_writer import BagWriter
from hexapod_doe.bags.completeness import EpisodeTally, describe
from hexapod_doe.bags.cuts import forget_cuts
from hexapod_doe.bags.decoding import stamp_ns
from hexapod_doe.bags.rosbag2 import Topic
from hexapod_doe.bags.run_bag import COMPLETE, RECORDING, evaluation_of, is_evaluation
from hexapod_doe.bags.schema import is_stamped
from hexapod_doe.errors import BagError


class Recording:
    """One run's bag, open.

    Attributes:
        run_id: of the run; results of other runs are not its own.
        results: episodes whose result is in the bag.
        evaluated: the same of the run's evaluation.
        incomplete: one line for each fault found in a sampled episode.
    """

    def __init__(
        self, run_id: str, bag: Path, metadata: Mapping[str, str], period_ns: int
    ) -> None:
        """Open the bag.

        Args:
            run_id: of the run.
            bag: directory that the bag will have when it is complete.
            metadata: stored in the bag at once; it says how long the run's evaluation is.
            period_ns: control period; 0 where samples keep no common grid.

        Raises:
            BagError: the bag cannot be opened.
        """
        self.run_id = run_id
        self.results: set[int] = set()
        self.evaluated: set[int] = set()
        self._evaluation = range(evaluation_of(metadata))
        self.incomplete: list[str] = []
        self._whole = 0
        """Every episode before this one has its result."""
        self._period_ns = period_ns
        self._newest_ns = 0
        self._tally: EpisodeTally | None = None
        self._sampled: dict[int, int] = {}  # control periods by episode
        self._episode = 0
        self._stamped: set[str] = set()
        own = {'run_id': run_id, 'status': RECORDING, 'recording_began': _now()}
        self._writer = BagWriter(bag, {**metadata, **own})

    @property
    def bag(self) -> Path:
        """Directory that the bag will have when it is complete."""
        return self._writer.bag

    @property
    def messages(self) -> int:
        """Messages in the bag."""
        return self._writer.extent.messages

    def add_result(self, topic: Topic, data: bytes, episode: int, steps: int) -> bool:
        """Store the result of an episode and make the bag safe up to here.

        Args:
            topic: that it came on, which tells whether it is of the run's evaluation.
            data: the message, serialised.
            episode: its number.
            steps: control periods that it lasted.

        Returns:
            Whether it is new; a second result of an episode is not stored.

        Raises:
            BagError: the disk refuses.
            ValueError: the message has no stamp that a bag can hold.
        """
        judged = is_evaluation(topic.name)
        had = self.evaluated if judged else self.results
        if episode in had:
            return False
        time_ns = _loggable_ns(data)
        had.add(episode)
        self._writer.add_topic(topic)
        self._writer.write(topic.name, data, time_ns)
        self._writer.flush()
        periods = self._sampled.get(episode, steps)
        if self._period_ns and periods != steps and not judged:
            self.incomplete.append(f'episode {episode}: {periods} of {steps} periods recorded')
        return True

    def begin_sample(self, episode: int, topics: Iterable[Topic]) -> None:
        """Begin to record every topic.

        Raises:
            BagError: a topic's type is not installed, or changed.
        """
        topics = tuple(topics)
        for topic in topics:
            self._writer.add_topic(topic)
        self._stamped = {topic.name for topic in topics if is_stamped(topic.type_name)}
        types = {topic.name: topic.type_name for topic in topics if topic.name in self._stamped}
        self._tally = EpisodeTally(types, self._period_ns)
        self._episode = episode

    def add_sample(self, topic: str, data: bytes) -> None:
        """Store one message of the sampled episode.

        Raises:
            BagError: the disk refuses.
            ValueError: the message has no stamp that a bag can hold.
        """
        if self._tally is None:
            return
        if topic in self._stamped:
            time_ns = _loggable_ns(data)
            self._tally.add(topic, time_ns)
            self._newest_ns = max(self._newest_ns, time_ns)
        else:
            time_ns = self._newest_ns
        self._writer.write(topic, data, time_ns)

    @property
    def sampling(self) -> bool:
        """Whether an episode is being recorded."""
        return self._tally is not None

    def waiting(self, last_ns: int) -> list[str]:
        """Return the topics that have yet to deliver their sample of the episode's end."""
        return self._tally.waiting(last_ns) if self._tally else []

    def end_sample(self, last_ns: int) -> list[str]:
        """End the sampled episode at a stamp; return one line for each fault.

        Raises:
            BagError: the disk refuses.
        """
        if self._tally is None:
            return []
        faults = describe(self._episode, self._tally.verdicts(last_ns))
        self._sampled[self._episode] = self._tally.periods(last_ns)
        self.incomplete += faults
        self._tally = None
        self._writer.flush()
        return faults

    def secure(self) -> None:
        """Return once the disk has everything so far.

        Raises:
            BagError: the disk refuses, or a later recording of the run has taken over.
        """
        self._writer.secure()

    def first_lacking(self, episodes: int) -> int | None:
        """Return the first of so many episodes that has no result yet; None if each has one."""
        while self._whole in self.results:
            self._whole += 1
        return self._whole if self._whole < episodes else None

    def lacking(self, episodes: int) -> str:
        """Return in words what results a run of so many episodes lacks; '' if it has all."""
        first = self.first_lacking(episodes)
        if first is not None:
            found = sum(episode < episodes for episode in self.results)
            return (
                f'{found} of {episodes} episode results recorded, episode {first} is the first to '
                'lack'
            )
        found = len(self.evaluated.intersection(self._evaluation))
        if found < len(self._evaluation):
            return f'{found} of {len(self._evaluation)} results of its evaluation recorded'
        return ''

    def finish(self, episodes: int, metadata: Mapping[str, str]) -> Path:
        """Close the bag and return it.

        Raises:
            BagError: an episode lacks its result, so the bag keeps its unfinished name; or the
                disk refuses.
        """
        if lacking := self.lacking(episodes):
            raise BagError(f'run {self.run_id}: {lacking}; the bag stays {self.abandon()}')
        self._note(metadata, COMPLETE, episodes)
        bag = self._writer.close()
        forget_cuts(bag, self._writer.metadata, closed=True)
        return bag

    def forget_cuts(self, keep: Path | None = None) -> None:
        """Remove recordings of the run that were cut, but for one, see `cuts`."""
        forget_cuts(self.bag, self._writer.metadata, keep)

    def abandon(self) -> Path:
        """End the file as it is, so that it can be read; the bag keeps its unfinished name."""
        self._note({}, RECORDING, len(self.results))
        return self._writer.abandon()

    def _note(self, metadata: Mapping[str, str], status: str, episodes: int) -> None:
        counts = self._writer.extent.counts
        self._writer.metadata |= {
            **metadata,
            'status': status,
            'episodes': str(episodes),
            'sampled_episodes': ' '.join(map(str, sorted(self._sampled))),
            'counts': '\n'.join(f'{topic} {count}' for topic, count in sorted(counts.items())),
            'incomplete': '\n'.join(self.incomplete),
            'recording_ended': _now(),
        }


def _loggable_ns(data: bytes) -> int:
    time_ns = stamp_ns(data)
    if time_ns < 0:
        raise ValueError(f'stamp {time_ns * 1e-9:.3f} s: before 1970, expected 0 s or later')
    return time_ns


def _now() -> str:
    return datetime.now(UTC).isoformat(timespec='seconds')
