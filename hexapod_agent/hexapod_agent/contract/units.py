# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Whether numbers are in our units, and within the scale that the agent normalises them by."""

from collections.abc import Iterator

import numpy as np
from hexapod_sim.channel import Field
from hexapod_sim.units import OTHER_UNITS

from hexapod_agent.contract.finding import Finding
from hexapod_agent.contract.subject import Subject

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
