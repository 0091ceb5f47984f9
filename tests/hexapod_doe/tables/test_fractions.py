# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Several fractions that were run as one design are taken apart again."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hexapod_doe.designs.design import fraction
from hexapod_doe.designs.plan_table import make_plan
from hexapod_doe.errors import TableError
from hexapod_doe.tables.csv_table import read_csv
from hexapod_doe.tables.fractions import runs_of
from hexapod_doe.tables.table import RunTable

SHARED = {'ABCDEFG', 'ABCE', 'ABD', 'ABFG', 'ACDG', 'ACF', 'ADEF', 'AEG'}
"""The cases that the article's two designs have in common, as its tables print them."""


@pytest.fixture
def joined(tmp_path: Path) -> RunTable:
    """Two runs of each case of both designs, whose response is the run's own number."""
    rows = make_plan(fraction('quarter+eighth'), 2).rows
    rows.assign(y=np.arange(len(rows))).to_csv(tmp_path / 'runs.csv', index=False)
    return read_csv(tmp_path / 'runs.csv', 'y')[0]


@pytest.mark.parametrize(('name', 'cases'), [('quarter', 32), ('eighth', 16)])
def test_each_fraction_has_all_its_runs(joined: RunTable, name: str, cases: int) -> None:
    part = runs_of(joined, name)
    assert (part.design, len(part.rows), part.rows['case'].nunique()) == (name, 2 * cases, cases)
    assert {tuple(row) for row in part.levels.to_numpy()} == {
        tuple(row) for row in fraction(name).levels
    }
    whole = joined.rows.set_index('run_id')
    pd.testing.assert_frame_equal(part.rows.set_index('run_id'), whole.loc[part.rows['run_id']])


def test_shared_cases_are_in_both(joined: RunTable) -> None:
    first, second = (set(runs_of(joined, name).rows['label']) for name in ('quarter', 'eighth'))
    assert first & second == SHARED
    assert len(first | second) == 40


def test_a_fraction_that_is_not_there_is_named(joined: RunTable) -> None:
    with pytest.raises(TableError, match="design 'third': expected one of full"):
        runs_of(joined, 'third')
    other = joined.rows[joined.rows['label'] == 'A']
    with pytest.raises(TableError, match="holds no case of the design 'eighth'"):
        runs_of(RunTable('mine', '', 'y', joined.factors, other), 'eighth')
