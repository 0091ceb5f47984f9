# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Scores recorded episodes with another reward: the task's own terms on what the bag holds.

The poses of `odom` and the distances of `line_offset` are the numbers that the task judged, so an
unchanged reward gives the recorded one to the last bit.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import yaml
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_sim.scenes.scene import Scene
from hexapod_sim.simulation import roll_pitch_yaw
from hexapod_sim.sums import ordered_sum
from hexapod_sim.task import DIVERGED, Outcome, diverged, judge, line_at
from hexapod_sim.task_config import TaskConfig

from hexapod_doe.bags.bag_file import BagFile
from hexapod_doe.errors import BagError
from hexapod_doe.replays.episodes import (
    LINE_OFFSET,
    ODOMETRY,
    STEP_OUTCOME,
    Series,
    Span,
    recorded_episodes,
    series_of_type,
)


@dataclass(frozen=True)
class Rescored:
    """One recorded episode under another reward.

    Attributes:
        episode: its number in the run.
        outcomes: of each control period, until the episode ends by the new task.
        recorded: rewards of the periods as the bag has them; empty where it has none.
    """

    episode: int
    outcomes: tuple[Outcome, ...]
    recorded: tuple[float, ...]

    @property
    def episode_return(self) -> float:
        """Sum of the rewards."""
        return ordered_sum(outcome.reward for outcome in self.outcomes)

    @property
    def recorded_return(self) -> float | None:
        """Sum of the recorded rewards; None where there are none."""
        return ordered_sum(self.recorded) if self.recorded else None

    @property
    def terms(self) -> dict[str, float]:
        """Sums of the reward terms."""
        names = self.outcomes[0].terms if self.outcomes else ()
        return {name: ordered_sum(o.terms[name] for o in self.outcomes) for name in names}

    @property
    def equal(self) -> int:
        """Periods whose reward is the recorded one to the last bit."""
        pairs = zip(self.outcomes, self.recorded, strict=False)
        return sum(outcome.reward.hex() == reward.hex() for outcome, reward in pairs)

    @property
    def cause(self) -> str:
        """Why the episode ends by the new task; empty where the recording ends before it."""
        return self.outcomes[-1].cause if self.outcomes else ''


def recorded_config(bag: BagFile) -> RunSpec:
    """Return a specification with scene, task and sensors of a run, if the bag tells.

    The rest is article.yaml's: an old bag's learner may know keys that this version does not.

    Raises:
        ConfigError: the task in the bag has an unknown key or value.
    """
    metadata = bag.metadata()
    config = yaml.safe_load(metadata.get('spec', metadata.get('config', ''))) or {}
    told = {name: config[name] for name in ('scene', 'task', 'sensors') if name in config}
    return RunSpec.from_mapping(told, f'bag {bag.path}')


def rescore(bag: BagFile, task: TaskConfig) -> Iterator[Rescored]:
    """Score each episode of which the bag holds `odom`.

    The distance from the line is that of `line_offset`; a task that moves the line differently
    shifts it by as much. A bag without this topic, or with errors in it, has its line where the
    task puts it.

    Raises:
        BagError: the bag has no odometry, or a sample of a topic is missing.
    """
    spec = recorded_config(bag)
    topics, before = _Topics(bag, spec.sensors['line_offset'].perfect), spec.task
    ground = spec.scene.make()
    for span in recorded_episodes(bag, topics.odom):
        yield _rescore_episode(topics.samples(span), span, before, task, ground)


@dataclass(frozen=True)
class _Sample:
    """What the bag holds of the end of one control period."""

    pose: tuple[float, ...]
    offset: float | None
    outcome: Any


class _Topics:
    """The topics that a score is made of."""

    def __init__(self, bag: BagFile, is_line_true: bool) -> None:
        self._bag = bag
        self.odom = Series(bag, 'odom', ODOMETRY)
        line = series_of_type(bag, LINE_OFFSET) if is_line_true else None
        self._others = line, series_of_type(bag, STEP_OUTCOME)

    def samples(self, span: Span) -> list[_Sample]:
        """Return the samples of an episode.

        Raises:
            BagError: a topic lacks one.
        """
        stamps = self.odom.within(span)
        for series in self._others:
            if series is not None and series.within(span) != stamps:
                raise BagError(
                    f'bag {self._bag.path}: episode {span.episode} has other stamps on '
                    f'{series.topic} than on {self.odom.topic}, expected a sample of each in '
                    'every control period'
                )
        offsets, outcomes = self._others
        return [
            _Sample(
                _pose(self.odom.at(stamp)),
                offsets.at(stamp).offset if offsets else None,
                outcomes.at(stamp) if outcomes else None,
            )
            for stamp in stamps
        ]


def _rescore_episode(
    samples: list[_Sample], span: Span, before: TaskConfig, task: TaskConfig, ground: Scene
) -> Rescored:
    outcomes: list[Outcome] = []
    for step, (last, sample) in enumerate(pairwise(samples), start=1):
        if sample.outcome and sample.outcome.cause == DIVERGED:
            outcome = diverged(step)
        else:
            offset = _offset(sample, step, before, task)
            under = float(ground.height(*sample.pose[:2]))
            outcome = judge(step, sample.pose, last.pose[0], offset, task, under)
        outcomes.append(outcome)
        if outcome.terminated or outcome.truncated:
            break
    recorded = tuple(sample.outcome.reward for sample in samples[1:] if sample.outcome)
    return Rescored(span.episode, tuple(outcomes), recorded)


def _offset(sample: _Sample, step: int, before: TaskConfig, task: TaskConfig) -> float:
    line = line_at(step, task)
    if sample.offset is None:
        return sample.pose[1] - line
    return sample.offset + (line_at(step, before) - line)


def _pose(message: Any) -> tuple[float, ...]:
    """Return x, y, z [m] and roll, pitch, yaw [rad] of an odometry message."""
    position, q = message.pose.pose.position, message.pose.pose.orientation
    return position.x, position.y, position.z, *roll_pitch_yaw(q.x, q.y, q.z, q.w)
