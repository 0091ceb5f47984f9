# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Parameters come from a table or a dataclass, described and limited."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Annotated

import pytest
import rclpy
from annotated_types import Interval
from hexapod_node.parameters import ConfigParameters, Parameter, config_table, declare, descriptor
from rclpy.exceptions import InvalidParameterTypeException, InvalidParameterValueException
from rclpy.node import Node
from rclpy.parameter import Parameter as RclpyParameter


@dataclass(frozen=True)
class Config:
    """A configuration."""

    speed: Annotated[float, Interval(ge=0.0, le=2.0)] = 0.5
    """Walking speed [m/s]."""
    legs: int = 6
    """How many
    there are."""
    ranges: tuple[float, float] = (0.0, 1.0)
    """Not a parameter: ROS has no nested values."""
    gait: str = 'tripod'


def test_scalar_fields_become_parameters_with_their_docs_and_units() -> None:
    speed, legs, gait = config_table(Config(), 'walk')
    assert (speed.name, speed.default, speed.description, speed.unit) == (
        'walk.speed',
        0.5,
        'Walking speed',
        'm/s',
    )
    assert speed.range == (0.0, 2.0)
    assert legs.range is None
    assert (legs.name, legs.default, legs.description) == ('walk.legs', 6, 'How many there are')
    assert (gait.name, gait.default, gait.description) == ('walk.gait', 'tripod', '')


@pytest.mark.parametrize(('default', 'kind'), [(1.0, 'floating_point'), (1, 'integer')])
def test_limits_are_of_the_type_of_the_value(default: float, kind: str) -> None:
    described = descriptor(Parameter('p', default, 'text', unit='s', range=(0, 2)))
    (limits,) = getattr(described, f'{kind}_range')
    assert (limits.from_value, limits.to_value) == (0, 2)
    assert described.description == 'text'
    assert described.additional_constraints == 'unit: s'


RATE = Parameter('rate', 1.0, 'how fast', range=(0.0, 10.0))
GAIN = Parameter('gain', 0.5, 'how much', range=(0.0, 10.0), read_only=False)
LOOP = Parameter('loop', False, 'whether', read_only=False)
COUNT = Parameter('count', 3, 'how many', read_only=False)
NAMES = Parameter('names', [''], 'which')


@pytest.fixture
def started() -> Iterator[Callable[..., Node]]:
    """Start a node with the table's parameters, as its command line would give them."""
    rclpy.init()
    nodes = []

    def start(**given) -> Node:
        overrides = [RclpyParameter(name, value=value) for name, value in given.items()]
        nodes.append(Node('test', parameter_overrides=overrides))
        declare(nodes[-1], (RATE, GAIN, LOOP, COUNT, NAMES))
        return nodes[-1]

    yield start
    for node in nodes:
        node.destroy_node()
    rclpy.shutdown()


def set_one(node: Node, name: str, value: object) -> tuple[bool, str]:
    (result,) = node.set_parameters([RclpyParameter(name, value=value)])
    return result.successful, result.reason


@pytest.mark.graph
@pytest.mark.parametrize(('given', 'value'), [({}, 1.0), ({'rate': 0}, 0.0), ({'rate': 2.5}, 2.5)])
def test_a_real_parameter_takes_a_whole_number_at_start(started, given, value) -> None:
    node = started(**given)
    parameter = node.get_parameter('rate')
    assert (parameter.value, parameter.type_) == (value, RclpyParameter.Type.DOUBLE)
    described = node.describe_parameter('rate')
    assert described.type == RclpyParameter.Type.DOUBLE.value
    assert described.read_only
    assert not described.dynamic_typing


@pytest.mark.graph
@pytest.mark.parametrize('given', ['a=1', ['a=1']])
def test_a_list_of_texts_takes_one_text_at_start(started, given) -> None:
    parameter = started(names=given).get_parameter('names')
    assert (parameter.value, parameter.type_) == (['a=1'], RclpyParameter.Type.STRING_ARRAY)


@pytest.mark.graph
def test_a_real_parameter_takes_a_whole_number_later(started) -> None:
    node = started()
    declare(node, [Parameter('late', 1.0, 'of a second table', read_only=False)])
    assert set_one(node, 'gain', 2) == (True, '')
    assert set_one(node, 'late', 7) == (True, '')
    assert [node.get_parameter(name).value for name in ('gain', 'late')] == [2.0, 7.0]
    assert isinstance(node.get_parameter('gain').value, float)
    assert set_one(node, 'count', 4) == (True, '')
    assert isinstance(node.get_parameter('count').value, int)


@pytest.mark.graph
@pytest.mark.parametrize(
    ('name', 'value'), [('gain', True), ('gain', 'fast'), ('count', 2.0), ('loop', 1)]
)
def test_other_types_are_refused(started, name, value) -> None:
    node = started()
    done, reason = set_one(node, name, value)
    assert not done
    assert 'Wrong parameter type' in reason
    with pytest.raises(InvalidParameterTypeException, match=name):
        started(**{name: value})


@pytest.mark.graph
def test_limits_hold_for_whole_numbers_too(started) -> None:
    assert set_one(started(), 'gain', 11)[0] is False
    with pytest.raises(InvalidParameterValueException, match='rate'):
        started(rate=11)


@pytest.mark.graph
def test_a_configuration_takes_whole_numbers(started) -> None:
    node = started()
    config = ConfigParameters(node, Config(speed=0.25), 'walk')
    assert config.get().speed == 0.25
    assert set_one(node, 'walk.speed', 2) == (True, '')
    assert config.get().speed == 2.0
    done, reason = set_one(node, 'walk.speed', 2.5)
    assert not done
    assert 'out of range' in reason
