# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Figures and effects of a study's table, by hand."""

import pandas as pd
import pytest
from hexapod_doe.studies.configuration_tables import effects, figures


@pytest.fixture
def results() -> pd.DataFrame:
    lines = [
        # row, sensors, seed, episode, return, offset, cpu_s
        ('+-', 'C', 5, 2, 0.0, 9.0, 1.0),
        ('+-', 'C', 5, 4, 10.0, 0.1, 2.0),
        ('+-', 'C', 6, 4, 20.0, 0.3, 4.0),
        ('-+', 'C', 5, 4, 50.0, 0.1, 6.0),
        ('++', 'C', 5, 4, 60.0, 0.1, 6.0),
        ('+-', 'none', 5, 4, 5.0, 0.1, 2.0),
        ('-+', 'none', 5, 4, 4.0, 0.1, 3.0),
    ]
    return pd.DataFrame(
        lines, columns=['row', 'sensors', 'seed', 'episode', 'return', 'offset', 'cpu_s']
    )


def test_figures_count_each_training_once(results):
    first = figures(results, failure=15.0).iloc[0]
    assert (first['row'], first['sensors'], first['trainings']) == ('+-', 'C', 2)
    # Standard deviation of 10 and 20 with one degree of freedom: 10 / sqrt(2).
    assert first['mean'] == 15.0
    assert first['deviation'] == pytest.approx(7.0711, abs=1e-4)
    assert (first['least'], first['failed'], first['cpu_s']) == (10.0, 1, 3.0)
    assert first['offset'] == pytest.approx(0.2)


def test_an_effect_is_the_difference_of_means_within_a_set(results):
    found = effects(results, ['ratio', 'norm']).set_index(['factor', 'sensors'])
    assert found.loc[('ratio', 'C'), 'return'] == pytest.approx(30.0 - 50.0)
    assert found.loc[('norm', 'C'), 'return'] == pytest.approx(55.0 - 15.0)
    assert found.loc[('norm', 'none'), 'cpu_s'] == pytest.approx(1.0)
