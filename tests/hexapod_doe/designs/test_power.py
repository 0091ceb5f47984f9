# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Power and smallest effect equal the reference table, and invert one another."""

import json
from pathlib import Path

import pytest
from hexapod_doe.designs.power import power, replicates_for, smallest_effect
from hypothesis import given
from hypothesis import strategies as st

DATA = Path(__file__).parents[2] / 'data' / 'doe_cases'
CHECKS = json.loads((DATA / 'formula_checks.json').read_text())
ROWS = CHECKS['power_table_alpha_0.05']


@pytest.mark.parametrize('row', ROWS, ids=lambda row: f'{row["N"]}-{row["params"]}')
def test_the_power_table_is_met_to_full_precision(row):
    runs, parameters = row['N'], row['params']
    assert power(0.5, runs, parameters) == pytest.approx(row['power_effect_0p5sigma'], abs=1e-9)
    assert power(1.0, runs, parameters) == pytest.approx(row['power_effect_1sigma'], abs=1e-9)
    assert smallest_effect(runs, parameters) == pytest.approx(row['mde80_in_sigma'], abs=1e-9)
    found = smallest_effect(runs, parameters, wanted=0.9)
    assert found == pytest.approx(row['mde90_in_sigma'], abs=1e-9)


def test_the_power_of_another_package_is_met():
    # dexpy 0.12 for the 2^(7-2), main effects only, an effect of one sigma.
    assert power(1.0, 32, 8) == pytest.approx(CHECKS['power_vs_dexpy']['dexpy'], abs=1e-12)


def test_without_an_effect_the_power_is_the_level():
    assert power(0.0, 64, 8, alpha=0.1) == 0.1


@given(st.integers(10, 500), st.floats(0.1, 100), st.floats(0.2, 0.99))
def test_the_smallest_effect_has_the_wanted_power_and_scales_with_sigma(runs, sigma, wanted):
    effect = smallest_effect(runs, 8, sigma, wanted=wanted)
    assert power(effect, runs, 8, sigma) == pytest.approx(wanted, abs=1e-6)
    assert effect == pytest.approx(sigma * smallest_effect(runs, 8, wanted=wanted), rel=1e-6)


def test_the_replicates_needed_are_the_fewest_that_suffice():
    # The reference table: 32 cases x 5 find .446 sigma, x 3 only .581.
    assert replicates_for(0.45, 32, 32) == 5
    assert power(0.45, 160, 32) >= 0.8 > power(0.45, 128, 32)


@pytest.mark.parametrize(
    ('call', 'message'),
    [
        (lambda: power(1, 32, 32), '32 runs, 32 parameters: .* at least 33 runs'),
        (lambda: power(1, 64, 32, sigma=0), 'sigma 0: expected a positive'),
        (lambda: power(1, 64, 32, alpha=1.5), 'alpha 1.5: expected a probability'),
        (lambda: smallest_effect(64, 32, wanted=0.01), 'power 0.01: expected .* alpha 0.05'),
        (lambda: replicates_for(0.001, 16, 8, limit=5), 'not found .* by 5 replicates'),
    ],
)
def test_impossible_questions_are_named(call, message):
    with pytest.raises(ValueError, match=message):
        call()
