# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Whether an IMU's axes and signs are ours: force up at rest, unit quaternions, upright."""

import math
from collections.abc import Iterator

import numpy as np
from hexapod_sim.robot import GRAVITY
from numpy.typing import NDArray

from hexapod_agent.contract.evidence import (
    ACCELERATION,
    ACCELERATION_COVARIANCE,
    COVARIANCES,
)
from hexapod_agent.contract.finding import Finding, Subject
from hexapod_agent.contract.plausibility import conversion, other_unit

_IMU = 'sensor_msgs/msg/Imu'
# REP-145: the first covariance is -1 where the device does not give the quantity.
NOT_GIVEN = -1.0
_AXES = 'xyz'
_STANDARD_ERRORS = 4.0


def check_gravity(subject: Subject) -> Iterator[Finding]:
    """Check that an accelerometer at rest reads +9.81 m/s² along z, upwards (REP-145)."""
    if subject.channel.message_type != _IMU:
        return
    if not _given(subject, ACCELERATION_COVARIANCE):
        yield _unchecked(subject)
        return
    readings = np.nan_to_num(subject.stack(ACCELERATION))
    mean = readings.mean(axis=0)
    norm = float(np.linalg.norm(mean))
    if norm == 0.0:
        yield _not_measured(subject)
        return
    # The steps of a walking robot make the mean of a short time uncertain.
    uncertain = _STANDARD_ERRORS * float(readings.std(axis=0).max()) / math.sqrt(len(readings))
    if abs(norm - GRAVITY) > max(subject.limits.gravity_error * GRAVITY, uncertain):
        yield _wrong_size(subject, norm)
    if mean[2] < norm * math.cos(subject.limits.max_tilt):
        yield _wrong_direction(subject, mean / norm)


def check_given(subject: Subject) -> Iterator[Finding]:
    """Check that nothing that is observed is marked as not measured."""
    for field in subject.channel.observed:
        covariance = COVARIANCES.get(field.path)
        if covariance is not None and not _given(subject, covariance):
            yield subject.finding(
                'not_measured',
                field.path,
                'is marked as not measured (covariance -1)',
                'a measured one',
                'take a device that measures it, or a set without this channel; where the device '
                'does measure it, let its driver give the covariance, or 0 for an unknown one',
            )


def check_orientation(subject: Subject) -> Iterator[Finding]:
    """Check that quaternions have norm 1 and an upright body, in the order x y z w."""
    if 'orientation' not in subject.channel.readings:
        return
    field, cure = 'orientation', 'fill it from a device with sensor fusion'
    q = subject.stack(field)
    with np.errstate(over='ignore'):  # a norm beyond all numbers is not 1 either
        norms = np.linalg.norm(q, axis=1)
    worst = float(norms[np.argmax(np.abs(norms - 1.0))])
    if abs(worst - 1.0) > subject.limits.norm_error:
        if worst > subject.limits.norm_error:
            cure = 'divide it by its norm in the driver'
        found = f'has a norm of {worst:.3f}'
        yield subject.finding('bad_quaternion', field, found, 'norm 1', cure)
        return
    if np.median(tilt(q)) > subject.limits.max_tilt:
        yield _tilted(subject, q)


def tilt(q: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the angle between the body's z axis and up, for quaternions x y z w (n, 4) [rad].

    The z component of the rotated z axis is 1 - 2 (x² + y²).
    """
    return np.arccos(np.clip(1.0 - 2.0 * (q[:, 0] ** 2 + q[:, 1] ** 2), -1.0, 1.0))


def _given(subject: Subject, covariance: str) -> bool:
    return all(sample.values[covariance][0] != NOT_GIVEN for sample in subject.samples)


def _unchecked(subject: Subject) -> Finding:
    return subject.finding(
        'not_measured',
        ACCELERATION,
        'is marked as not measured (covariance -1)',
        'a measured one, to tell whether axes and signs are ours',
        'see by hand that the device sits with x forward, y left, z up',
        'note',
    )


def _not_measured(subject: Subject) -> Finding:
    return subject.finding(
        'not_measured',
        ACCELERATION,
        'is zero',
        f'+{GRAVITY:g} m/s² on z at rest, or a covariance that begins with -1',
        'fill it, so that axes and signs can be checked',
        'warning',
    )


def _wrong_size(subject: Subject, norm: float) -> Finding:
    error = subject.limits.gravity_error
    name, factor = other_unit('m/s²', norm, (1 + error) * GRAVITY, (1 - error) * GRAVITY)
    guess = f', which looks like {name}' if name else ''
    return subject.finding(
        'wrong_unit',
        ACCELERATION,
        f'has a mean of {norm:.4g}{guess}',
        f'{GRAVITY:g} m/s²',
        conversion('m/s²', name, factor),
    )


def _wrong_direction(subject: Subject, up: NDArray[np.float64]) -> Finding:
    axis = int(np.argmax(np.abs(up)))
    sign = '+' if up[axis] > 0 else '-'
    flipped = axis == 2
    return subject.finding(
        'flipped_gravity' if flipped else 'wrong_axes',
        f'{ACCELERATION}.z' if flipped else ACCELERATION,
        f'points to {sign}{_AXES[axis]} at rest',
        f'the specific force, +{GRAVITY:g} m/s² on z',
        'negate it, or turn the device: it reports gravity itself, or hangs upside down'
        if flipped
        else 'turn the readings into x forward, y left, z up',
    )


def _tilted(subject: Subject, q: NDArray[np.float64]) -> Finding:
    found = f'says that the body is tilted by {np.degrees(np.median(tilt(q))):.0f} degrees'
    expected = 'an upright robot, quaternion x y z w of base_link in a frame with z up'
    if np.median(tilt(np.roll(q, -1, axis=1))) <= subject.limits.max_tilt:
        cure = 'publish x y z w: the numbers come as w x y z'
    else:
        cure = 'turn it into x forward, y left, z up (REP-103); a NED device has z down'
    return subject.finding('bad_quaternion', 'orientation', found, expected, cure)
