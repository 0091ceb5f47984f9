# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Writes tables for spreadsheets: a text of foreign origin does not become a formula there."""

from pathlib import Path

import pandas as pd
from pandas.api.types import is_numeric_dtype

from hexapod_doe.sheets.numbers import number

_FORMULA = ('=', '+', '-', '@', '\t', '\r', '\n', '＝', '＋', '－', '＠')
"""How a cell begins that a spreadsheet may compute."""


def write_csv(table: pd.DataFrame, path: Path) -> None:
    """Write a CSV file; texts that a spreadsheet would compute get a `'` in front of them."""
    plain = table.apply(lambda column: column if is_numeric_dtype(column) else column.map(inert))
    plain = plain.rename(columns=inert)
    plain.to_csv(path, index=False, lineterminator='\n')


def inert(cell: object) -> object:
    """Return a cell that no spreadsheet takes for a formula; numbers stay as they are."""
    if not isinstance(cell, str) or not cell.startswith(_FORMULA):
        return cell
    try:
        number(cell)
    except ValueError:
        return f"'{cell}"
    return cell
