# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Reads bags without ROS: a run's metadata and episodes, and any topic's messages."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pandas as pd
from hexapod_agent.learning import metrics

from hexapod_doe.bags.bag_file import BagFile
from hexapod_doe.bags.bag_state import find_bags, is_complete
from hexapod_doe.errors import BagError

__all__ = ['RunRecord', 'find_bags', 'is_complete', 'read_run', 'read_topic']

_FIELDS = (
    'episode',
    'steps',
    'episode_return',
    'average_return',
    'terminated',
    'cause',
    'late',
    'missing',
    'duplicate',
    'out_of_order',
)


@dataclass(frozen=True)
class RunRecord:
    """What the analysis needs of one run."""

    run_id: str
    metadata: dict[str, str]
    """Design row, seed, parameters, versions, and what the recorder found."""
    episodes: pd.DataFrame
    """A row per episode, by its number: the fields of EpisodeResult, reward terms as `term_*`,
    and the learner's metrics by their names."""
    evaluation: pd.DataFrame = field(default_factory=pd.DataFrame)
    """The same of the evaluation at the end; empty where there was none."""


def read_run(bag: str | Path) -> RunRecord:
    """Read a run's bag.

    Raises:
        BagError: missing, unfinished, cut, empty, or not a bag of a run.
    """
    file = BagFile(Path(bag))
    metadata = file.run_metadata()
    episodes = _episodes(file, [file.result_topic()])
    if episodes.empty:
        raise BagError(f'bag {bag}: empty, expected at least one episode result')
    evaluation = _episodes(file, file.evaluation_topics())
    return RunRecord(metadata['run_id'], metadata, episodes, evaluation)


def read_topic(bag: str | Path, topic: str, kind: str = '') -> Iterator[tuple[int, Any]]:
    """Yield (time [ns], decoded message) of one topic, in the order of time.

    Args:
        bag: a rosbag2 directory with MCAP storage, ours or not, or one of its files.
        topic: the full name, or its end where only one topic ends so ('imu/data').
        kind: message type that it must have; '' for any.

    Raises:
        BagError: the bag cannot be read, or has no such topic of that type.
    """
    file = BagFile(Path(bag))
    yield from file.decoded(file.topic(topic, kind))


def _episodes(file: BagFile, topics: Iterable[str]) -> pd.DataFrame:
    results = [result for topic in topics for _, result in file.decoded(topic)]
    if not results:
        return pd.DataFrame()
    episodes = pd.DataFrame([_episode_row(result) for result in results])
    return episodes.drop_duplicates('episode').set_index('episode').sort_index()


def _episode_row(result: Any) -> dict[str, Any]:
    stamp = result.header.stamp
    terms = zip(result.term_names, result.term_values, strict=True)
    return (
        _metrics(result)
        | {name: getattr(result, name) for name in _FIELDS}
        | {f'term_{name}': value for name, value in terms}
        | {'stamp_ns': stamp.sec * 1_000_000_000 + stamp.nanosec}
    )


def _metrics(result: Any) -> dict[str, float]:
    """Return the learner's metrics by name; bags of before have them as fields of the message."""
    if hasattr(result, 'metric_names'):
        return dict(zip(result.metric_names, result.metric_values, strict=True))
    names = (metric.name for metric in metrics.METRICS)
    return {name: float(getattr(result, name)) for name in names if hasattr(result, name)}
