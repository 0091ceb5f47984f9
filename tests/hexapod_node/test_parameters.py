# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Parameters come from a table or a dataclass, described and limited."""

from dataclasses import dataclass

import pytest
from hexapod_node.parameters import Parameter, config_table, descriptor


@dataclass(frozen=True)
class Config:
    """A configuration."""

    speed: float = 0.5
    """Walking speed [m/s]."""
    legs: int = 6
    """How many
    there are."""
    ranges: tuple[float, float] = (0.0, 1.0)
    """Not a parameter: ROS has no nested values."""
    gait: str = 'tripod'


def test_scalar_fields_become_parameters_with_their_docs_and_units() -> None:
    speed, legs, gait = config_table(Config, 'walk')
    assert (speed.name, speed.default, speed.description, speed.unit) == (
        'walk.speed',
        0.5,
        'Walking speed',
        'm/s',
    )
    assert (legs.name, legs.default, legs.description) == ('walk.legs', 6, 'How many there are')
    assert (gait.name, gait.default, gait.description) == ('walk.gait', 'tripod', '')


@pytest.mark.parametrize(('default', 'kind'), [(1.0, 'floating_point'), (1, 'integer')])
def test_limits_are_of_the_type_of_the_value(default: float, kind: str) -> None:
    described = descriptor(Parameter('p', default, 'text', unit='s', range=(0, 2)))
    (limits,) = getattr(described, f'{kind}_range')
    assert (limits.from_value, limits.to_value) == (0, 2)
    assert described.description == 'text'
    assert described.additional_constraints == 'unit: s'
