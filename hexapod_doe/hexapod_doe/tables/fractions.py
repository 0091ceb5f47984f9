# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Takes the runs of one fraction out of a table of several fractions that were run as one."""

from dataclasses import replace

import numpy as np

from hexapod_doe.designs.design import fraction
from hexapod_doe.errors import TableError
from hexapod_doe.tables.table import RunTable


def runs_of(table: RunTable, name: str) -> RunTable:
    """Return the table of the runs whose cases a named fraction holds.

    Args:
        table: Runs of any design.
        name: Of the fraction of the table's factors, see `designs.design.fraction`.

    Raises:
        TableError: There is no such fraction, or the table has none of its cases.
    """
    try:
        design = fraction(name, ''.join(table.factors))
    except ValueError as error:
        raise TableError(str(error)) from error
    cases = {tuple(row) for row in design.levels}
    kept = np.array([tuple(row) in cases for row in table.levels.to_numpy()])
    if not kept.any():
        raise TableError(f'{table.title}: holds no case of the design {name!r}')
    rows = table.rows[kept].reset_index(drop=True)
    curves = table.curves[table.curves['run_id'].isin(rows['run_id'])].reset_index(drop=True)
    return replace(table, rows=rows, curves=curves, design=name)
