# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Whether readings are in our units and fit the robot: scale, weight, motion, range finder."""

from collections.abc import Iterator, Sequence

import numpy as np
from hexapod_sim.channel import Field
from hexapod_sim.robot import GRAVITY, TOTAL_MASS
from hexapod_sim.sums import ordered_sum
from hexapod_sim.units import OTHER_UNITS
from numpy.typing import NDArray

from hexapod_agent.contract.evidence import RANGE_LIMITS
from hexapod_agent.contract.finding import Finding, Subject
from hexapod_agent.contract.timing import stamps_of

# A few wild numbers do not make another unit.
_USUAL_PERCENTILE = 95
# Below this share of the scale nothing tells one unit from another.
_AT_REST = 0.01


def check_units(subject: Subject) -> Iterator[Finding]:
    """Check each observed field's magnitudes."""
    for field in subject.channel.observed:
        usual = usual_magnitude(subject, field.path)
        if usual > field.limit:
            yield _wrong_unit(subject, field, usual)
        else:
            yield from _check_scale(subject, field)


def usual_magnitude(subject: Subject, path: str) -> float:
    """Return the magnitude that few of a field's numbers exceed."""
    return float(np.percentile(np.abs(subject.stack(path)), _USUAL_PERCENTILE))


def other_unit(unit: str, found: float, most: float, least: float = 0.0) -> tuple[str, float]:
    """Return the unit in which a magnitude is plausible, and how many of it make one of ours.

    Returns:
        ('', 1.0) if it is so in none that drivers use.
    """
    for name, factor in OTHER_UNITS.get(unit, ()):
        if least <= found / factor <= most:
            return name, factor
    return '', 1.0


def conversion(unit: str, name: str, factor: float) -> str:
    """Return the cure for a driver that publishes in another unit."""
    if not name:
        return f'let the driver publish {unit}'
    return f'let the driver publish {unit}: divide by {factor:.4g}'


def _wrong_unit(subject: Subject, field: Field, usual: float) -> Finding:
    name, factor = other_unit(field.unit, usual, field.limit)
    guess = f', which looks like {name}' if name else ''
    return subject.finding(
        'wrong_unit',
        field.path,
        f'reaches {usual:.4g}{guess}',
        f'{field.unit} up to {field.limit:.4g}',
        conversion(field.unit, name, factor),
    )


def _check_scale(subject: Subject, field: Field) -> Iterator[Finding]:
    """Warn of numbers that are clipped, and say where the unit cannot be seen."""
    values = subject.stack(field.path)
    clipped = float((np.abs(values - field.center) > field.scale).mean())
    if clipped > subject.limits.clipped_share:
        span = f'{field.center:g} ± {field.scale:g}' if field.center else f'±{field.scale:g}'
        yield subject.finding(
            'clipped',
            field.path,
            f'lies beyond the scale for {100.0 * clipped:.0f} % of the numbers',
            f'{span} {field.unit}',
            'see whether the robot moves as in training; the agent sees these numbers clipped',
            'warning',
        )
    if field.unit in ('rad/s', 'm/s') and np.abs(values).max() < _AT_REST * field.scale:
        yield subject.finding(
            'at_rest',
            field.path,
            'is at rest',
            f'movement, to tell whether it is in {field.unit}',
            'check again while the robot walks',
            'note',
        )


# The mean force on all feet is the weight; friction, tares and steps make it uncertain.
_WEIGHT = TOTAL_MASS * GRAVITY
_LEAST_WEIGHT, _MOST_WEIGHT = 0.5 * _WEIGHT, 1.5 * _WEIGHT
# Angles and velocities that belong together are correlated at least so, and of one size.
_LEAST_CORRELATION = 0.7
_LEAST_SLOPE, _MOST_SLOPE = 0.5, 2.0
_LEAST_MOTION = 0.05  # rad/s, root mean square: the steps of an encoder stay below
_LEAST_STEPS = 20


def check_weight(subjects: Sequence[Subject]) -> Iterator[Finding]:
    """Check that the feet together carry the robot, which tells the unit of their forces."""
    if subjects[0].channel.readings != ('foot_forces',):
        return
    forces = (np.abs(subject.stack('wrench.force')[:, 2]) for subject in subjects)
    normal = ordered_sum(float(force.mean()) for force in forces)
    if _LEAST_WEIGHT <= normal <= _MOST_WEIGHT:
        return
    name, factor = other_unit('N', normal, _MOST_WEIGHT, _LEAST_WEIGHT)
    field, expected = 'wrench.force.z', f"{_WEIGHT:.1f} N, the robot's weight"
    found = f'adds up to {normal:.4g} over the feet'
    if name:
        found += f', which looks like {name}'
        yield subjects[0].finding(
            'wrong_unit', field, found, expected, conversion('N', name, factor)
        )
    else:
        cure = 'set the robot on its feet, tare the load cells, check their gain'
        yield subjects[0].finding('wrong_weight', field, found, expected, cure)


def check_contacts(subject: Subject) -> Iterator[Finding]:
    """Check that some foot touches the ground at times."""
    if 'foot_contacts' in subject.channel.readings and not subject.stack('contact').any():
        yield subject.finding(
            'no_contact',
            'contact',
            'is false for all feet all the time',
            'a foot on the ground',
            'set the robot on its feet; look for switches that close on release',
        )


def check_range(subject: Subject) -> Iterator[Finding]:
    """Check the distances against the limits that the device itself gives."""
    if 'height' not in subject.channel.readings:
        return
    distance = subject.stack('range')
    least, most = (subject.stack(path) for path in RANGE_LIMITS)
    outside = float(((distance < least) | (distance > most)).mean())
    if outside > subject.limits.clipped_share:
        yield subject.finding(
            'out_of_range',
            'range',
            f'lies outside min_range … max_range for {100.0 * outside:.0f} % of the messages',
            f'{least[-1, 0]:.3g} … {most[-1, 0]:.3g}',
            'set min_range and max_range in m, and see that nothing blocks the device',
        )


def check_motion(subject: Subject) -> Iterator[Finding]:
    """Check joint velocities against the change of the joint angles: unit and sign."""
    if 'joint_velocities' not in subject.channel.readings:
        return
    if usual_magnitude(subject, 'position') > subject.channel.observed[0].limit:
        return  # angles in degrees say nothing about the velocities
    fitted = _slope(subject)
    if fitted is None or _LEAST_SLOPE <= fitted <= _MOST_SLOPE:
        return
    found, expected = f'is {fitted:.3g} times the change of position', '1, rad/s and our sign'
    name, factor = '', 1.0
    if fitted > 0.0:
        for unit, many in OTHER_UNITS['rad/s']:
            if _LEAST_SLOPE <= fitted / many <= _MOST_SLOPE:
                name, factor = unit, many
    if name:
        found += f', which looks like {name}'
    cure = conversion('rad/s', name, factor) if fitted > 0.0 else 'negate it in the driver'
    kind = 'wrong_unit' if fitted > 0.0 else 'wrong_sign'
    yield subject.finding(kind, 'velocity', found, expected, cure)


def _slope(subject: Subject) -> float | None:
    """Return how many units of velocity make one of the angles' change; None at rest.

    The ratio of root mean squares with the sign of the correlation: noise in one of them does not
    pull it to zero as it would a regression.
    """
    steps = np.diff(stamps_of(subject.samples)) * 1e-9
    if len(steps) < _LEAST_STEPS or (steps <= 0.0).any():
        return None
    velocity = subject.stack('velocity')
    change = np.diff(subject.stack('position'), axis=0) / steps[:, None]
    middle = 0.5 * (velocity[1:] + velocity[:-1])
    if _rms(change) < _LEAST_MOTION or _rms(middle) < _LEAST_MOTION:
        return None
    correlation = float(np.corrcoef(change.ravel(), middle.ravel())[0, 1])
    if abs(correlation) < _LEAST_CORRELATION:
        return None
    return float(np.copysign(_rms(middle) / _rms(change), correlation))


def _rms(values: NDArray[np.float64]) -> float:
    return float(np.sqrt(np.mean(values**2)))
