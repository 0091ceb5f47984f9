# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hexapod_doe.analysis.analysis import analyse
from hexapod_doe.choosing.devices import DeviceTable, read_devices
from hexapod_doe.choosing.purchase import any_breaks, cheapest_not_worse, letters_of, pareto
from hexapod_doe.designs.design import fraction
from hexapod_doe.errors import AnalysisError
from hexapod_doe.fitting.model import corners, labels
from hexapod_doe.records.findings import Purchase
from hexapod_doe.records.options import Options
from simulated import Truth, repeated_levels, table_of


@pytest.fixture(scope='module')
def devices() -> DeviceTable:
    return read_devices()


@pytest.fixture(scope='module')
def bought() -> Purchase:
    levels = repeated_levels(fraction('quarter'), 10)
    response = Truth().simulate(levels, np.random.default_rng(1))
    return analyse([table_of(levels, response)], Options(delta=25.0)).purchase


def names(table: DeviceTable, letters: str) -> list[str]:
    return [device.name for device in table.cheapest(letters)]


def test_one_imu_gives_both_letters(devices: DeviceTable) -> None:
    assert names(devices, 'C') == names(devices, 'D') == names(devices, 'CD')


def test_load_cells_give_contacts_for_free(devices: DeviceTable) -> None:
    assert names(devices, 'FG') == ['six load cells']
    assert names(devices, 'G') == ['six foot switches']
    assert names(devices, '') == []


def test_costs_are_monotone_in_the_set(devices: DeviceTable) -> None:
    sets = [letters_of(label) for label in labels(corners('ABCDEFG'))]
    cost = {frozenset(letters): sum(d.cost for d in devices.cheapest(letters)) for letters in sets}
    assert all(cost[one] <= cost[two] for one in cost for two in cost if one <= two)


def test_a_letter_that_no_device_yields(devices: DeviceTable) -> None:
    with pytest.raises(AnalysisError, match="no device yields 'Z'"):
        devices.cheapest('Z')


@pytest.mark.parametrize(
    ('text', 'message'),
    [
        ('currency: EUR', 'expected the keys'),
        (
            'currency: EUR\ndelta_share: 0.1\nconfidence: 0.9\ndevices: [{name: x}]',
            'expected the keys cost, failure_probability, mass, name, power, yields',
        ),
        (
            'currency: EUR\ndelta_share: 0.1\nconfidence: 0.9\ndevices: [{name: x, yields: A, '
            'cost: -1, mass: 0, power: 0, failure_probability: 0}]',
            "device 'x': cost is negative",
        ),
    ],
)
def test_faults_of_a_device_table(tmp_path: Path, text: str, message: str) -> None:
    (tmp_path / 'devices.yaml').write_text(text)
    with pytest.raises(AnalysisError, match=message):
        read_devices(tmp_path / 'devices.yaml')


def test_the_front_by_its_definition() -> None:
    rng = np.random.default_rng(2)
    cost = rng.integers(0, 6, 20).astype(float)
    values = rng.integers(0, 8, (50, 20)).astype(float)
    found = pareto(cost, values)
    for row, front in zip(values, found, strict=True):
        for i in range(20):
            beaten = ((cost <= cost[i]) & (row > row[i])) | ((cost < cost[i]) & (row >= row[i]))
            assert front[i] == (not beaten.any())


def test_the_cheapest_set_that_reaches_the_confidence() -> None:
    cost, sure = np.array([5.0, 1.0, 3.0]), np.array([1.0, 0.2, 0.95])
    label, rule = cheapest_not_worse(['ABC', 'A', 'AB'], cost, sure, np.zeros(3), 0.9)
    assert label == 'AB'
    assert '0.95' in rule
    label, rule = cheapest_not_worse(['ABC', 'A', 'AB'], cost, 0.5 * sure, np.zeros(3), 0.9)
    assert label == 'ABC'
    assert 'no set is within delta' in rule


def test_the_cheapest_set_is_cheap_and_good(bought: Purchase) -> None:
    sets = {item.label: item for item in bought.sets}
    chosen = sets[bought.cheapest]
    assert chosen.p_not_worse >= bought.confidence == 0.9
    assert not any(
        item.cost < chosen.cost and item.p_not_worse >= bought.confidence for item in bought.sets
    )


def test_the_front_rises_with_its_cost(bought: Purchase) -> None:
    sets = {item.label: item for item in bought.sets}
    front = [sets[label] for label in bought.front]
    assert all(one.cost < two.cost and one.fit < two.fit for one, two in pairwise(front))
    assert bought.front[0] == '(none)'


def test_what_breaks_is_lost(bought: Purchase) -> None:
    sets = {item.label: item for item in bought.sets}
    imu = next(item for item in bought.breakage if item.device == 'IMU with fusion')
    assert set(imu.lost) == {'C', 'D'} & set(imu.label)
    assert set(imu.remaining) == set(imu.label) - set(imu.lost)
    assert imu.loss == pytest.approx(sets[imu.label].fit - sets[imu.remaining].fit)
    assert imu.loss_ci[0] < imu.loss < imu.loss_ci[1]


def test_broken_devices_are_independent(devices: DeviceTable) -> None:
    pair = devices.cheapest('CE')
    expected = 1 - (1 - pair[0].failure_probability) * (1 - pair[1].failure_probability)
    assert any_breaks(pair) == pytest.approx(expected)


def test_a_table_of_other_factors_is_not_priced() -> None:
    levels = repeated_levels(fraction('full', 3), 3)
    response = np.random.default_rng(3).normal(size=len(levels))
    assert analyse([table_of(levels, response)], Options()).purchase is None
