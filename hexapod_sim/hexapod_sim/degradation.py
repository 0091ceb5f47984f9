# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What a device makes of the truth: errors, samples that are late, rare or lost, from a seed."""

import math
import zlib
from collections import deque
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from hexapod_sim.channel import Channel, Field, Numbers
from hexapod_sim.quality import Quality

_MOST_STEPS = 2.0**52
_ROUNDING = 1e-9  # of a time that is a whole number of periods

Readings = Mapping[str, Numbers]


class Degradation:
    """The device of one topic during one episode.

    Its errors depend on the seed, the topic and the count of samples alone: on no other channel,
    and noise not on what is lost. It begins with a good sample, whatever its delay and dropout.

    Attributes:
        newest: Readings that arrived last.
        stamp_ns: When they were measured.
        lost: Count of samples that were dropped.
    """

    def __init__(self, channel: Channel, topic: str, quality: Quality, seed: int) -> None:
        """Begin before the first sample.

        Args:
            channel: The topic's.
            topic: Its relative name, which tells it apart from others of the same seed.
            quality: How good the device is.
            seed: Of all that is random, such as an episode's.
        """
        root = np.random.SeedSequence(seed, spawn_key=(zlib.crc32(topic.encode()),))
        biases, noise, self._losses = map(np.random.default_rng, root.spawn(3))
        first = channel.observed[0]
        self._errors = [
            _FieldErrors(field, quality, field.scale / first.scale, biases, noise)
            for field in channel.observed
        ]
        self._quality = quality
        self._start_ns: int | None = None
        self._turn = 0
        self._under_way: deque[tuple[int, Readings]] = deque()
        self.newest: Readings = {}
        self.stamp_ns = 0
        self.lost = 0

    def sample(self, stamp_ns: int, truth: Readings) -> bool:
        """Measure, and return whether a sample has arrived since.

        Args:
            stamp_ns: Time of now.
            truth: Readings of the fields, as a message of the topic has them.
        """
        measured = {**truth, **{e.field.reading: e.apply(truth) for e in self._errors}}
        due = self._due(stamp_ns)
        lost = self._losses.random() < self._quality.dropout
        self.lost += due and lost
        # Time went back, or a stamp was wrong: nobody waits for what lies ahead of it.
        while self._under_way and self._under_way[-1][0] > stamp_ns:
            self._under_way.pop()
        if due and not lost:
            self._under_way.append((stamp_ns, measured))
        arrived = False
        while self._under_way and self._under_way[0][0] <= stamp_ns - self._delay_ns:
            self.stamp_ns, self.newest = self._under_way.popleft()
            arrived = True
        if not self.newest:
            self.stamp_ns, self.newest = stamp_ns, measured
        return arrived

    @property
    def _delay_ns(self) -> int:
        return round(self._quality.delay * 1e9)

    def _due(self, stamp_ns: int) -> bool:
        """Return whether the device measures now: the first time in a period of its own."""
        if self._start_ns is None:
            self._start_ns = stamp_ns
            return True
        if not self._quality.rate:
            return True
        elapsed = (stamp_ns - self._start_ns) * 1e-9
        before, self._turn = self._turn, math.floor(elapsed * self._quality.rate + _ROUNDING)
        return self._turn != before


class _FieldErrors:
    """Errors of one field's numbers; without any, these pass bit for bit."""

    def __init__(
        self,
        field: Field,
        quality: Quality,
        share: float,
        biases: np.random.Generator,
        noise: np.random.Generator,
    ) -> None:
        self.field = field
        self._noise, self._step = share * quality.noise, share * quality.quantisation
        self._size = 3 if field.kind == 'quaternion' else field.size
        self._bias = share * quality.bias * biases.standard_normal(self._size)
        self._exact = not (quality.noise or quality.bias or quality.quantisation)
        self._random = noise

    def apply(self, truth: Readings) -> Numbers:
        values = truth[self.field.reading]
        if self._exact:
            return values
        if self.field.kind == 'switch':
            flipped = self._random.random(values.size) < self._noise
            return np.where(flipped, 1.0 - values, values)
        error = self._bias + self._noise * self._random.standard_normal(self._size)
        if self.field.kind == 'quaternion':
            turned = self._quantised(multiply(values, from_rotation(error)))
            return turned / np.linalg.norm(turned)  # devices give the norm 1
        return self.field.carried(self._quantised(values + error))

    def _quantised(self, values: Numbers) -> Numbers:
        if not self._step:
            return values
        with np.errstate(over='ignore'):
            steps = values / self._step
        # Beyond that many steps, neighbouring doubles are further apart than the steps.
        fine = np.abs(steps) >= _MOST_STEPS
        return np.where(fine, values, self._step * np.round(steps))


def from_rotation(rotation: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the quaternion x y z w of a rotation vector (3,) [rad]."""
    half = 0.5 * float(np.linalg.norm(rotation))
    # sin(half) / (2 half) times the vector, without dividing by zero: numpy's sinc has pi in it.
    return np.append(0.5 * np.sinc(half / np.pi) * rotation, np.cos(half))


def multiply(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return Hamilton's product of quaternions x y z w: first b, then a."""
    vector = a[3] * b[:3] + b[3] * a[:3] + np.cross(a[:3], b[:3])
    return np.append(vector, a[3] * b[3] - a[:3] @ b[:3])
