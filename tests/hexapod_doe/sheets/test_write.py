# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Foreign text is no formula in the report's CSV files; numbers and other text stay."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hexapod_doe.reporting.tables import Table
from hexapod_doe.sheets.write import inert, write_csv
from hexapod_doe.tables.csv_table import read_csv


@pytest.mark.parametrize(
    'text',
    ['=HYPERLINK("x")', '+cmd|/C calc', '-1+1', '@SUM(A1)', '\t=1', '＝1+1', '=1', '-A'],
)
def test_a_formula_is_a_text(tmp_path: Path, text: str) -> None:
    write_csv(pd.DataFrame({text: [text], 'n': [-1.5]}), tmp_path / 'out.csv')
    back = pd.read_csv(tmp_path / 'out.csv')
    assert list(back.columns) == [f"'{text}", 'n']
    assert back.iloc[0].tolist() == [f"'{text}", -1.5]


@pytest.mark.parametrize('cell', ['-1.5', '+2', '-1e-3', 'ACE', '(none)', '', 'a=b', -1.5, None])
def test_numbers_and_other_text_stay(cell: object) -> None:
    assert inert(cell) == cell


def test_numbers_keep_every_digit(tmp_path: Path) -> None:
    values = np.random.default_rng(1).normal(size=50)
    table = pd.DataFrame({'x': values, 'k': range(-25, 25)})
    write_csv(table, tmp_path / 'out.csv')
    table.to_csv(tmp_path / 'plain.csv', index=False, lineterminator='\n')
    assert (tmp_path / 'out.csv').read_bytes() == (tmp_path / 'plain.csv').read_bytes()


def test_a_run_named_by_a_formula_in_the_reports_table(tmp_path: Path) -> None:
    text = '=HYPERLINK("http://x.invalid")'
    rows = pd.DataFrame({'run_id': [text, 'b'], 'A': [-1, 1], 'y': [1.0, 2.0]})
    rows.to_csv(tmp_path / 'foreign.csv', index=False)
    (table,) = read_csv(tmp_path / 'foreign.csv', 'y')
    assert table.rows['run_id'].tolist() == [text, 'b']
    Table('runs', '', '', {}, table.rows).save(tmp_path)
    back = pd.read_csv(tmp_path / 'runs.csv')
    assert back['run_id'].tolist() == [f"'{text}", 'b']
    assert back['A'].tolist() == [-1, 1]
