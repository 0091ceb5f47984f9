# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The sensor table adds up, and the vector is normalised, ordered and guarded."""

import numpy as np
import pytest
from hexapod_agent.specification.observation import (
    ObservationError,
    ObservationSpec,
    parse_observations,
)
from hexapod_sim.sensor_table import CHANNELS, LETTERS


def readings(value: float = 0.0) -> dict[str, np.ndarray]:
    """Every reading of the table, filled with one value."""
    return {
        quantity.name: np.full(quantity.size, value)
        for channel in CHANNELS
        for quantity in channel.quantities
    }


@pytest.mark.parametrize(('letters', 'size'), [('', 79), ('ABCDE', 108), ('ABCDEFG', 126)])
def test_sizes_are_those_of_the_article(letters, size):
    spec = ObservationSpec(letters)
    assert spec.size == size
    assert spec.assemble(readings(), np.zeros(30)).shape == (size,)


def test_a_set_has_one_spelling():
    assert parse_observations('EBA') == parse_observations('ABEA') == 'ABE'


def test_unknown_letter_is_named():
    with pytest.raises(ValueError, match=r"observations 'ABX': unknown letter 'X'.*ABCDEFG"):
        parse_observations('ABX')


def test_only_chosen_topics_are_subscribed_to():
    assert ObservationSpec('').topics == ('joint_states', 'cpg/state', 'line_offset')
    assert ObservationSpec('EC').topics[3:] == ('imu/data', 'body/height')
    assert len(ObservationSpec('F').topics) == 3 + 6


def test_channels_keep_the_order_of_the_table():
    values = readings()
    values['line_offset'] = np.array([0.25])
    values['height'] = np.array([0.14])
    vector = ObservationSpec('E').assemble(values, np.full(30, 0.5))
    np.testing.assert_array_equal(vector[48:78], np.full(30, 0.5, np.float32))
    scale = {channel.name: channel.quantities[0].scale for channel in CHANNELS}
    assert vector[78] == pytest.approx(0.25 / scale['line offset'])
    assert vector[79] == pytest.approx((0.14 - 0.13) / scale['body height'])
    assert vector.dtype == np.float32


def test_numbers_are_clipped_to_one():
    assert ObservationSpec(LETTERS).assemble(readings(1e9), np.ones(30)).max() == 1.0
    assert ObservationSpec(LETTERS).assemble(readings(-1e9), np.ones(30)).min() == -1.0


@pytest.mark.parametrize('value', [np.nan, np.inf])
def test_reading_that_is_not_finite_is_named(value):
    values = readings()
    values['joint_torques'][3] = value
    with pytest.raises(ObservationError, match=r"channel 'joint torques': joint_torques\[3\]"):
        ObservationSpec('A').assemble(values, np.zeros(30))
    assert np.isfinite(ObservationSpec('B').assemble(values, np.zeros(30))).all()


def test_reading_of_wrong_length_is_named():
    values = readings()
    values['orientation'] = np.zeros(1)
    with pytest.raises(ObservationError, match=r'body orientation.*1 numbers, expected 4'):
        ObservationSpec('C').assemble(values, np.zeros(30))


def test_missing_reading_is_named():
    values = readings()
    del values['foot_contacts']
    with pytest.raises(ObservationError, match=r'foot contacts.*nothing, expected 6'):
        ObservationSpec('G').assemble(values, np.zeros(30))
