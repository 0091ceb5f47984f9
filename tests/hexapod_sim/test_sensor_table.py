# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Every row of the sensor table is whole, and agrees with the robot and the pattern generator."""

from __future__ import annotations

import numpy as np
import pytest
from hexapod_cpg.mapping import ACTION_SIZE
from hexapod_node.raw_topics import message_class
from hexapod_sim.channel import Channel, Derived, Field
from hexapod_sim.message_fields import read
from hexapod_sim.sensor_table import CHANNELS, LETTERS, PREVIOUS_ACTION

HEARD = [channel for channel in CHANNELS if channel.topics]


def test_letters_begin_with_those_of_the_article() -> None:
    assert LETTERS.startswith('ABCDEFG')
    assert len(set(LETTERS)) == len(LETTERS)


def test_the_previous_action_is_as_long_as_an_action() -> None:
    (quantity,) = [q for row in CHANNELS for q in row.quantities if q.name == PREVIOUS_ACTION]
    assert quantity.size == ACTION_SIZE


@pytest.mark.parametrize('channel', HEARD, ids=lambda channel: channel.name)
def test_fields_and_constants_are_those_of_the_message(channel: Channel) -> None:
    kind = message_class(channel.message_type)
    message = kind(**channel.constants)
    for field in channel.fields:
        if not channel.has_joints:
            assert read(message, field.path).size == field.size
    assert channel.frames == () or len(channel.frames) == len(channel.topics)


def test_keys_name_the_devices_once() -> None:
    keys = [channel.key for channel in HEARD]
    assert len(set(keys)) == len(keys)
    assert {'imu_data', 'imu_data_raw', 'foot_force', 'body_height'} < set(keys)


def test_fields_that_share_a_reading_are_one_quantity() -> None:
    fields = (Field('x', 'both', 2, 'm', 1.0), Field('y', 'both', 3, 'm', 1.0))
    row = Channel('', 'pair', ('pair',), '', fields, 'none')
    assert [(q.name, q.size) for q in row.quantities] == [('both', 5)]


def test_a_field_without_a_scale_comes_along_unobserved() -> None:
    row = Channel(
        'Z', 'z', ('z',), '', (Field('a', 'a', 1, 'm', 2.0), Field('b', 'b', 1, 'm')), 'd'
    )
    assert row.readings == ('a',)
    assert row.size == 1


def test_a_derived_quantity_takes_the_place_of_its_reading() -> None:
    double = Derived('double', 1, lambda reading: 2.0 * reading.sum(axis=0))
    row = Channel(
        'Z', 'z', ('z/1', 'z/2'), '', (Field('a', 'a', 1, 'm', 1.0),), 'd', derived=double
    )
    assert row.device_topic == 'z'
    observed = row.observe({'a': np.array([[1.0], [2.0]])})
    assert observed == {'double': np.array([6.0])}
