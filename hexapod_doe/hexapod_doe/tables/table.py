# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The tidy table that every analysis starts from, one row per run, and its validation."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
import pandas as pd

from hexapod_doe.designs.factor import Factor
from hexapod_doe.errors import TableError
from hexapod_doe.fitting.blocks import block_basis, no_blocks
from hexapod_doe.fitting.model import centre_points, labels

RESPONSE = 'response'
BLOCK = 'block'
CURVE_COLUMNS = ('run_id', 'label', 'case', 'replicate', 'episode', 'return', 'average')
TERM_PREFIX = 'term_'
"""Begins the columns of the curves that hold reward terms."""


@dataclass(frozen=True)
class RunTable:
    """Runs of one design.

    `rows` has run_id, case, replicate, run_order, label, one column per factor, response, and
    block if the runs are in blocks.
    """

    title: str
    source: str
    response: str
    factors: tuple[str, ...]
    rows: pd.DataFrame
    caveats: tuple[str, ...] = ()
    design: str = ''
    named: tuple[Factor, ...] = ()
    """The factors as a plan has them; empty where columns have letters alone."""
    curves: pd.DataFrame = field(default_factory=lambda: pd.DataFrame(columns=CURVE_COLUMNS))
    block_column: str = ''
    """What the blocks are of, such as `seed`; empty if the runs are in none."""
    settings: Mapping[str, str] = field(default_factory=dict)
    """Length and configuration of the runs, see `bags.run_identity`; empty for other tables."""

    @property
    def factor_names(self) -> dict[str, str]:
        """The names of the factors by letter, as far as they have one."""
        return {factor.letter: factor.name for factor in self.named}

    @property
    def levels(self) -> pd.DataFrame:
        """Coded levels of the rows."""
        return self.rows[list(self.factors)]

    @property
    def values(self) -> np.ndarray:
        """The response (n,)."""
        return self.rows[RESPONSE].to_numpy(float)

    @property
    def all_blocks(self) -> np.ndarray:
        """Basis of the differences between the blocks of all rows (n, b)."""
        return self.block_basis(np.ones(len(self.rows), dtype=bool))

    def block_basis(self, kept: np.ndarray) -> np.ndarray:
        """Return the basis of the differences between blocks of the rows kept (kept, b)."""
        if not self.block_column:
            return no_blocks(int(kept.sum()))
        return block_basis(self.rows.loc[kept, BLOCK].to_numpy())


def build_rows(raw: pd.DataFrame, factors: Sequence[str]) -> tuple[pd.DataFrame, tuple[str, ...]]:
    """Return validated rows, and what a reader must know about them.

    Args:
        raw: Factor columns and `response`; run_id, case, StdOrder, replicate, RunOrder, block if
            known.
        factors: Factor letters.

    Raises:
        TableError: A level is not ±1, a factor never changes, the response is not a number, is
            the same everywhere or is nowhere, a run occurs twice with two results, or blocks
            cannot be told from cases.
    """
    _check_levels(raw, factors)
    response, dropped = _finite_response(raw)
    raw = raw.assign(**{RESPONSE: response})
    raw, repeated = _without_repeats(raw[np.isfinite(response)].reset_index(drop=True), factors)
    _check_variation(raw, factors)
    case, renumbered = _cases(raw, factors)
    replicate = case.groupby(case).cumcount() + 1
    if (
        'replicate' in raw
        and not pd.DataFrame({'c': case, 'r': raw['replicate']}).duplicated().any()
    ):
        replicate = raw['replicate']
    rows = pd.DataFrame(
        {
            'run_id': _run_ids(raw),
            'case': case,
            'replicate': replicate,
            'run_order': _run_order(raw),
            'label': labels(raw[list(factors)]),
            **{factor: raw[factor].astype(int) for factor in factors},
            RESPONSE: raw[RESPONSE].astype(float),
            **({BLOCK: raw[BLOCK]} if BLOCK in raw else {}),
        }
    )
    if BLOCK in rows and (fault := block_fault(rows['case'], rows[BLOCK])):
        raise TableError(fault)
    return rows, (*dropped, *repeated, *renumbered)


def _check_levels(raw: pd.DataFrame, factors: Sequence[str]) -> None:
    if raw.empty:
        raise TableError('the table has no rows')
    levels = raw[list(factors)].apply(pd.to_numeric, errors='coerce')
    if fault := _level_fault(levels):
        row, factor, expected = fault
        raise TableError(
            f'row {row + 1}, column {factor!r}: level {raw[factor].iloc[row]:g}, {expected}'
        )


def _level_fault(levels: pd.DataFrame) -> tuple[int, str, str] | None:
    """Return the row and factor of a level that cannot be, and what was expected.

    One level 0 in one row is taken for a slip, not for the centre of a factor.
    """
    wrong = ~levels.isin([-1, 0, 1])
    if wrong.to_numpy().any():
        row, column = np.argwhere(wrong.to_numpy())[0]
        return int(row), str(levels.columns[column]), 'expected -1 or 1'
    zero = levels.eq(0)
    rows = np.flatnonzero(centre_points(levels))
    if not len(rows):
        return None
    odd = zero.ne(zero.iloc[rows[0]], axis=1).iloc[rows]
    if odd.to_numpy().any() or zero.to_numpy().sum() == 1:
        row = rows[int(np.argmax(odd.any(axis=1)))]
        factor = str(levels.columns[int(np.argmax(zero.iloc[row]))])
        return (
            int(row),
            factor,
            (
                'expected -1 or 1 (0 only in centre points, which have the same factors at 0: '
                'the numeric ones)'
            ),
        )
    return None


def _finite_response(raw: pd.DataFrame) -> tuple[np.ndarray, tuple[str, ...]]:
    column = raw[RESPONSE]
    values = pd.to_numeric(column, errors='coerce').to_numpy(float)
    unread = np.isnan(values) & column.notna().to_numpy()
    if unread.any():
        row = int(np.argmax(unread))
        raise TableError(f'row {row + 1}: response {column.iloc[row]!r}, expected a number')
    missing = np.flatnonzero(~np.isfinite(values))
    if len(missing) == len(values):
        raise TableError('no row has a response')
    if not len(missing):
        return values, ()
    rows = ', '.join(str(row + 1) for row in missing[:10]) + (' …' if len(missing) > 10 else '')
    return values, (f'{len(missing)} rows have no response and are left out (row {rows}).',)


def _check_variation(raw: pd.DataFrame, factors: Sequence[str]) -> None:
    for factor in factors:
        if raw[factor].nunique() < 2:
            raise TableError(
                f'factor {factor!r} is {raw[factor].iloc[0]} in every row: its effect cannot be '
                'seen; leave it out with --factors'
            )
    if raw[RESPONSE].nunique() < 2:
        raise TableError(
            f'the response is {raw[RESPONSE].iloc[0]:g} in every row: there is nothing to explain'
        )


def block_fault(case: pd.Series, block: pd.Series) -> str:
    """Return why the differences between blocks cannot be taken out; empty if they can.

    Args:
        case: The case of each run.
        block: Its block.
    """
    missing = block.isna().to_numpy()
    if missing.any():
        return f'row {int(np.argmax(missing)) + 1}: no block, expected one in every row'
    cases = case.groupby(block).nunique()
    if len(cases) < 2:
        return f'every run is in block {cases.index[0]}, expected two blocks or more'
    if cases.max() < 2:
        return (
            'no block holds runs of two cases, so that differences between blocks cannot be told '
            'from those between cases; plan --common-seeds gives every case the same seeds'
        )
    return ''


def _without_repeats(
    raw: pd.DataFrame, factors: Sequence[str]
) -> tuple[pd.DataFrame, tuple[str, ...]]:
    """Drop a run that is listed twice; runs without a name of their own are replicates.

    A name that comes again with other levels names another run: plans that follow each other, as a
    base and its fold, number their runs alike.
    """
    again: list[str] = []
    for key in (['run_id'], ['RunOrder'], ['case', 'replicate'], ['StdOrder', 'replicate']):
        if not set(key) <= set(raw.columns):
            continue
        same_run = raw.duplicated([*key, *factors])
        if (raw.duplicated(key) & ~same_run).any():
            again.append(' and '.join(key))  # so that it names no run, of the same levels either
        elif same_run.any():
            return _dropped(raw, key, same_run)
    if again:
        text = (
            f'Numbers of {"; ".join(again)} come again with other levels: the rows are taken as '
            'runs of their own, of plans that follow each other.'
        )
        return raw, (text,)
    if raw.duplicated().any() and not {'replicate', 'run_id', 'RunOrder'} & set(raw.columns):
        count = int(raw.duplicated().sum())
        text = (
            f'{count} rows equal another one; nothing names the runs, so they count as replicates.'
        )
        return raw, (text,)
    return raw, ()


def _dropped(
    raw: pd.DataFrame, key: Sequence[str], same_run: pd.Series
) -> tuple[pd.DataFrame, tuple[str, ...]]:
    """Leave out rows that repeat another one to the last number."""
    first = raw.index[same_run][0]
    name = ', '.join(f'{column} {raw[column][first]}' for column in key)
    same = raw.duplicated()
    if not same[same_run].all():
        raise TableError(f'{name} occurs twice with different results, expected it once')
    text = f'{int(same.sum())} rows repeat another one ({name}) and are left out.'
    return raw[~same].reset_index(drop=True), (text,)


def _run_order(raw: pd.DataFrame) -> pd.Series:
    """Return the order of the runs; numbers that come again follow those that came before."""
    if 'RunOrder' not in raw:
        return pd.Series(raw.index + 1, index=raw.index)
    order = raw['RunOrder']
    if not order.duplicated().any():
        return order
    first = order.groupby(order).cumcount()
    ranked = pd.DataFrame({'plan': first, 'order': order}).sort_values(['plan', 'order']).index
    return pd.Series(np.arange(1, len(raw) + 1), index=ranked).sort_index()


def _run_ids(raw: pd.DataFrame) -> pd.Series:
    """Return names of the runs; those that come again get a number."""
    if 'run_id' not in raw:
        return pd.Series([f'row {i + 1}' for i in raw.index], index=raw.index)
    names = raw['run_id'].astype(str)
    count = names.groupby(names).cumcount() + 1
    return names.where(count == 1, names + ' (' + count.astype(str) + ')')


def _cases(raw: pd.DataFrame, factors: Sequence[str]) -> tuple[pd.Series, tuple[str, ...]]:
    """Number the cases as the table does, if it gives each combination one number of its own."""
    combination = raw.groupby(list(factors), sort=False).ngroup()
    for name in ('case', 'StdOrder'):
        if name not in raw:
            continue
        pairs = pd.DataFrame({'combination': combination, 'number': raw[name]}).drop_duplicates()
        if not (pairs['combination'].duplicated().any() or pairs['number'].duplicated().any()):
            return raw[name], ()
        if name == 'case':
            text = "The column 'case' disagrees with the levels; cases are numbered by the levels."
            return _yates(raw, factors), (text,)
    return _yates(raw, factors), ()


def _yates(raw: pd.DataFrame, factors: Sequence[str]) -> pd.Series:
    levels = raw[list(factors)]
    weights = 2 ** np.arange(len(factors))
    position = ((levels.to_numpy(float) > 0) * weights).sum(axis=1)
    position = position + np.where(centre_points(levels), 2 ** len(factors), 0)
    return pd.Series(position).rank(method='dense').astype(int)
