# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Designs that are analysed side by side have the same factors, and say where they differ."""

from dataclasses import replace

import numpy as np
import pytest
from hexapod_doe.analysis.analysis import analyse
from hexapod_doe.designs.factor import Factor, default_factors
from hexapod_doe.errors import TableError
from hexapod_doe.fitting.model import corners
from hexapod_doe.records.options import Options
from hexapod_doe.tables.table import RunTable
from simulated import table_of


@pytest.fixture
def table() -> RunTable:
    """Two sensors, two runs a case, all with one weight of the reward."""
    levels = corners('AB').loc[[0, 1, 2, 3] * 2].reset_index(drop=True)
    response = 3 * levels['A'] + np.random.default_rng(1).normal(size=len(levels))
    made = table_of(levels, response.to_numpy())
    settings = {'config.task.height_weight': '0.5'}
    return replace(made, named=default_factors('AB'), settings=settings)


def test_another_base_is_said(table: RunTable) -> None:
    other = replace(table, title='later', settings={'config.task.height_weight': '0.7'})
    caveats = analyse([table, other], Options()).caveats
    assert any('later' in each and 'height_weight 0.7, expected 0.5' in each for each in caveats)
    alike = analyse([table, replace(table, title='later')], Options()).caveats
    assert not any('later' in each for each in alike)


def test_other_factors_are_refused(table: RunTable) -> None:
    named = (table.named[0], Factor('B', 'yaw share', 'task.yaw_share', 0.0, 1.0))
    with pytest.raises(TableError, match=r'later: factors .* yaw share 0 → 1, expected those of'):
        analyse([table, replace(table, title='later', named=named)], Options())
