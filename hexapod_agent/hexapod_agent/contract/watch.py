# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Watches one topic while the robot walks: what each message can tell, in microseconds.

A message that looks right costs a few comparisons; only for one that does not the checks of the
contract run on it, for their words.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from hexapod_sim.channel import Channel
from hexapod_sim.joint_names import joint_order
from hexapod_sim.robot import CONTROL_PERIOD_NS, GRAVITY

from hexapod_agent.contract import inertial, plausibility, shape
from hexapod_agent.contract.evidence import (
    ACCELERATION,
    ACCELERATION_COVARIANCE,
    COVARIANCES,
    Evidence,
    Sample,
    TopicEvidence,
    checked_paths,
    sample,
)
from hexapod_agent.contract.finding import Finding, Subject
from hexapod_agent.contract.limits import Limits

# A driver in another unit now and then sends numbers that would do in ours, and an accelerometer
# of a walking robot points anywhere: a fault of these kinds lasts until a second went well, and
# gravity is looked for in the mean of about half a second.
_PERSISTENT = ('wrong_unit', 'flipped_gravity', 'wrong_axes')
_SECOND = 1_000_000_000 // CONTROL_PERIOD_NS
_SMOOTHING = 2.0 / _SECOND
# How far steps may take that mean from 9.81 m/s^2, relative.
_MEAN_ERROR = 0.6
# What a foot's impact gives; a single wild number must not stay in the mean for long.
_MOST_FORCE = 10.0 * GRAVITY

_Check = Callable[[Subject], Iterator[Finding]]
_IN_ONE_MESSAGE: tuple[_Check, ...] = (
    shape.check_frame,
    shape.check_shape,
    inertial.check_given,
    shape.check_finite,
    plausibility.check_units,
    inertial.check_orientation,
)


class MessageWatch:
    """One topic under watch."""

    def __init__(self, channel: Channel, topic: str, limits: Limits | None = None) -> None:
        """Begin without a fault.

        Args:
            channel: of the sensor table.
            topic: one of its topics, relative.
            limits: tolerances; None for the usual ones.
        """
        self._channel, self._topic = channel, topic
        self._limits = limits or Limits()
        self._paths = checked_paths(channel)
        self._fields = channel.observed
        paths = [COVARIANCES.get(field.path) for field in self._fields]
        self._covariances = [path for path in paths if path is not None]
        frames = dict(zip(channel.topics, channel.frames, strict=False))
        self._frame = self._limits.frames.get(topic, frames.get(topic))
        self._force = np.array([0.0, 0.0, GRAVITY])
        self._size = GRAVITY
        self._persisting: Finding | None = None
        self._good = 0

    def check(self, message: Any) -> Finding | None:
        """Return the first fault that a message shows or that has not passed yet, or None."""
        taken = sample(message, self._paths, 0)
        fault = None if self._looks_right(taken) else self._first_fault(taken)
        if fault is None:
            fault = self._gravity_fault(taken)
        if fault is not None and fault.kind in _PERSISTENT:
            self._persisting, self._good = fault, 0
        elif self._persisting is not None:
            self._good += 1
            if self._good >= _SECOND:
                self._persisting = None
        return fault or self._persisting

    def _looks_right(self, taken: Sample) -> bool:
        """Whether frame, names, lengths and magnitudes are those of the table."""
        if self._frame is not None and taken.frame != self._frame:
            return False
        joints = self._channel.has_joints
        if joints:
            try:
                order = joint_order(taken.names)
            except ValueError:
                return False
        for field in self._fields:
            values = taken.values[field.path]
            if values.size != (len(taken.names) if joints else field.size):
                return False
            ours = values if not joints or order is None else values[order]
            if not np.abs(ours).max() <= field.limit:  # nor NaN
                return False
            if field.path == 'orientation' and not self._is_unit(values):
                return False
        return all(taken.values[path][0] != inertial.NOT_GIVEN for path in self._covariances)

    def _is_unit(self, quaternion: Any) -> bool:
        norm = math.hypot(*quaternion.tolist())
        return abs(norm - 1.0) <= self._limits.norm_error

    def _first_fault(self, taken: Sample) -> Finding | None:
        subject = self._subject(taken)
        for check in _IN_ONE_MESSAGE:
            for finding in check(subject):
                if finding.level == 'fault':
                    return finding
        return None

    def _gravity_fault(self, taken: Sample) -> Finding | None:
        """Return a fault if the mean specific force does not point upwards."""
        force = taken.values.get(ACCELERATION)
        if force is None or not np.isfinite(force).all():
            return None
        jolt = np.clip(force, -_MOST_FORCE, _MOST_FORCE)
        self._force += _SMOOTHING * (jolt - self._force)
        self._size += _SMOOTHING * (math.hypot(*jolt.tolist()) - self._size)
        small = self._size < (1.0 - _MEAN_ERROR) * GRAVITY
        if not small and self._force[2] >= GRAVITY * math.cos(self._limits.max_tilt):
            return None
        values = {
            ACCELERATION: self._force,
            ACCELERATION_COVARIANCE: taken.values[ACCELERATION_COVARIANCE],
        }
        mean = Sample(0, 0, taken.frame, (), values)
        # A mean on its way from up to down is small as well: its size alone says nothing then.
        found = inertial.check_gravity(self._subject(mean, _MEAN_ERROR))
        return next((each for each in found if (each.kind == 'wrong_unit') == small), None)

    def _subject(self, taken: Sample, gravity_error: float | None = None) -> Subject:
        limits = self._limits
        if gravity_error is not None:
            limits = replace(limits, gravity_error=gravity_error)
        heard = TopicEvidence(self._topic, samples=(taken,))
        evidence = Evidence({self._topic: heard}, 0)
        return Subject(self._channel, self._topic, evidence, limits, reliable=False)
