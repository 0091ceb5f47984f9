# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What was heard of the robots, for the threads that show it: written by one, read by many."""

import math
import threading
from collections import Counter, deque
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

from hexapod_sim.world import World

from hexapod_bringup.watching.signals import JOINT_STATES

OUTCOME, ODOMETRY = 'step_outcome', 'odom'
_KEPT_SAMPLES = 400  # 10 s of simulated time
_KEPT_EPISODES = 5000


@dataclass(frozen=True)
class Pose:
    """Where base_link is in odom."""

    position: tuple[float, float, float]
    """[m]"""
    orientation: tuple[float, float, float, float]
    """Quaternion x y z w."""


class Track:
    """The newest samples of a topic, numbered as they came."""

    def __init__(self) -> None:
        self.count = 0
        self._samples: deque[tuple[float, list[float]]] = deque(maxlen=_KEPT_SAMPLES)

    def add(self, time_s: float, values: Sequence[float]) -> None:
        """Keep a sample; one of the past begins the track anew, as a restarted sim does."""
        if self._samples and time_s < self._samples[-1][0]:
            self._samples.clear()
        self._samples.append((time_s, list(values)))
        self.count += 1

    def since(self, number: int) -> tuple[list[float], list[list[float]]]:
        """Return times [s] and values of the samples from a number on."""
        count = min(max(self.count - number, 0), len(self._samples))
        samples = list(self._samples)[-count:] if count else []
        return [time_s for time_s, _ in samples], [values for _, values in samples]

    @property
    def newest(self) -> list[float] | None:
        """Values of the last sample."""
        return self._samples[-1][1] if self._samples else None


@dataclass
class Robot:
    """What is known of one robot; whoever reads or writes it holds the board's lock."""

    name: str
    """Its namespace below that of the watch, empty for the same."""
    tracks: dict[str, Track] = field(default_factory=dict)
    """Samples by topic."""
    episodes: deque[dict[str, Any]] = field(default_factory=lambda: deque(maxlen=_KEPT_EPISODES))
    """Results, oldest first."""
    episode_count: int = 0
    """Results since the watch began."""
    outcome: dict[str, Any] = field(default_factory=dict)
    """What the last control period earned."""
    pose: Pose | None = None
    world: World | None = None
    """What the sim says it is made of; None where there is no sim."""
    speed: float = math.nan
    """Simulated seconds per second."""
    heard: tuple[str, ...] = ()
    """Topics that somebody else listens to."""

    def track(self, topic: str) -> Track:
        """Return the samples of a topic."""
        return self.tracks.setdefault(topic, Track())

    def add_episode(self, result: dict[str, Any]) -> None:
        """Keep the result of an episode."""
        self.episodes.append(result)
        self.episode_count += 1

    @property
    def joints(self) -> list[float] | None:
        """Joint angles (18,) [rad]."""
        track = self.tracks.get(JOINT_STATES)
        return track.newest if track else None


@dataclass
class Seen:
    """What a page has of a robot already."""

    samples: Counter[str] = field(default_factory=Counter)
    episodes: int = 0


class Board:
    """All robots, who looks at which of them, and the campaign."""

    def __init__(self) -> None:
        self.lock = threading.RLock()
        self.robots: dict[str, Robot] = {}
        self.campaign_folder: str | None = None
        """Where the plan lies of the campaign that is under way."""
        self._watched: Counter[tuple[str, bool]] = Counter()

    @contextmanager
    def watching(self, name: str, every: bool) -> Iterator[None]:
        """Have a robot's topics heard for as long as the context lasts.

        Args:
            name: of the robot; it may come later.
            every: whether sensors that nobody else hears are wanted too.
        """
        with self.lock:
            self._watched[name, every] += 1
        try:
            yield
        finally:
            with self.lock:
                self._watched[name, every] -= 1

    def watched(self) -> dict[str, bool]:
        """Return by robot that is looked at whether every sensor of it is wanted."""
        with self.lock:
            wanted = [pair for pair, count in self._watched.items() if count > 0]
        return {name: (name, True) in wanted for name, _ in wanted}

    def news(self, name: str, seen: Seen) -> Mapping[str, Any]:
        """Return what a page lacks of a robot, and note that it has it."""
        with self.lock:
            told: dict[str, Any] = {'robots': sorted(self.robots), 'robot': name}
            robot = self.robots.get(name)
            if robot is None:
                return told
            told |= {'outcome': robot.outcome, 'heard': robot.heard, 'samples': {}}
            told['speed'] = None if math.isnan(robot.speed) else round(robot.speed, 2)
            for topic, track in robot.tracks.items():
                times, values = track.since(seen.samples[topic])
                if times:
                    told['samples'][topic] = {'t': times, 'v': [_rounded(v) for v in values]}
                seen.samples[topic] = track.count
            fresh = robot.episode_count - seen.episodes
            told['episodes'] = list(robot.episodes)[-fresh:] if fresh else []
            seen.episodes = robot.episode_count
            return told


def _rounded(values: Sequence[float]) -> list[float | None]:
    """Return numbers short enough to be sent often; None for what is none."""
    return [round(value, 4) if math.isfinite(value) else None for value in values]
