# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A plan as files: `plan.csv`, which the campaign reads, and `plan.json`, how it was made."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from hexapod_agent.specification.run_spec import RunSpec

from hexapod_doe.designs.factor import Treatments, sensors
from hexapod_doe.designs.factor_file import factors_of
from hexapod_doe.designs.plan_types import Confirmation, Plan, PlanSettings
from hexapod_doe.errors import TableError
from hexapod_doe.sheets.numbers import plain
from hexapod_doe.sheets.sheet import read_sheet

_INTEGERS = ('StdOrder', 'RunOrder', 'case', 'replicate', 'seed')
REQUIRED = (*_INTEGERS, 'run_id', 'observations')
"""Columns that every plan has, beside its factor columns."""
_RUN_ID = r'[A-Za-z][A-Za-z0-9_]*'
_SEED_LIMIT = 2**64
_LISTS = ('blocks', 'confirms')
"""Settings that JSON has as lists."""


class PlanError(ValueError):
    """A plan file does not hold a plan; the message names the file, the row and the value."""


def write_plan(plan: Plan, path: Path) -> None:
    """Write a plan and, beside it, its settings as JSON."""
    path.parent.mkdir(parents=True, exist_ok=True)
    plan.rows.to_csv(path, index=False, lineterminator='\n')
    if plan.settings is not None:
        text = json.dumps(plan.settings.as_dict(), indent=2)
        path.with_suffix('.json').write_text(text + '\n', encoding='utf-8')


def read_plan(path: Path) -> Plan:
    """Read and check a plan; its settings are None where no JSON file lies beside it.

    Raises:
        FileNotFoundError: There is no such file.
        PlanError: The table is not a plan.
    """
    try:
        sheet = read_sheet(path, REQUIRED)
    except TableError as error:
        raise PlanError(str(error)) from error
    twice = [name for name in sheet.headings if sheet.headings.count(name) > 1]
    if twice:
        raise PlanError(f'{path}: column {twice[0]!r} occurs twice, expected it once')
    text = sheet.cells.set_axis(list(sheet.headings), axis=1).reset_index(drop=True)
    rows = _parse(text, path)
    plan = Plan(rows, _read_settings(path.with_suffix('.json')))
    _check(plan, path)
    return plan


def _parse(text: pd.DataFrame, path: Path) -> pd.DataFrame:
    missing = [name for name in REQUIRED if name not in text.columns]
    if missing:
        raise PlanError(f'{path}: no column {missing[0]!r}, expected {", ".join(REQUIRED)}')
    factors = [name for name in text.columns if len(name) == 1]
    if not factors:
        raise PlanError(f'{path}: no factor columns, expected one per letter, such as A to G')
    if text.empty:
        raise PlanError(f'{path}: no rows, expected one per training run')
    rows = text.copy()
    for name in [*_INTEGERS, *(['block'] if 'block' in text else []), *factors]:
        rows[name] = [_integer(value, name, row, path) for row, value in text[name].items()]
    return rows


def _integer(value: str, column: str, row: object, path: Path) -> int:
    try:
        return int(plain(value))
    except ValueError as error:
        where = f'{path} row {int(str(row)) + 1}'
        raise PlanError(f'{where}: {column} is {value!r}, expected an integer') from error


def _check(plan: Plan, path: Path) -> None:
    rows, factors = plan.rows, plan.factors
    if plan.treatments.letters != factors:
        raise PlanError(
            f'{path}: factor columns {factors}, expected {plan.treatments.letters} '
            f'by {path.with_suffix(".json").name}'
        )
    for index, row in rows.iterrows():
        where = f'{path} row {int(str(index)) + 1}'
        for factor in factors:
            if row[factor] not in (-1, 1):
                raise PlanError(f'{where}: level {factor} is {row[factor]}, expected -1 or 1')
        expected = plan.treatments.observations([row[factor] for factor in factors])
        if row['observations'] != expected:
            raise PlanError(
                f'{where}: observations {row["observations"]!r}, expected {expected!r} '
                f'by the factor columns{_without_settings(plan, path)}'
            )
        if not 0 <= row['seed'] < _SEED_LIMIT:
            raise PlanError(f'{where}: seed {row["seed"]}, expected 0 to 2^64 - 1')
    _check_keys(rows, path)
    if (rows.groupby('case')[list(factors)].nunique() > 1).any(axis=None):
        raise PlanError(f'{path}: a case has rows of different levels, expected one set per case')


def _without_settings(plan: Plan, path: Path) -> str:
    """Return for a message that the file which names factors is missing; empty if it is not."""
    name = path.with_suffix('.json').name
    return '' if plan.settings else f'; {name}, which names other factors, is not beside it'


def _check_keys(rows: pd.DataFrame, path: Path) -> None:
    bad = rows.loc[~rows['run_id'].str.fullmatch(_RUN_ID), 'run_id']
    if len(bad):
        raise PlanError(
            f'{path}: run_id {bad.iloc[0]!r}, expected a letter, then letters, digits and _'
        )
    for key in (['run_id'], ['StdOrder'], ['case', 'replicate']):
        twice = rows[rows.duplicated(key)]
        if len(twice):
            value = ', '.join(f'{name} {twice.iloc[0][name]}' for name in key)
            raise PlanError(f'{path}: {value} occurs twice, expected it once')
    if not np.array_equal(np.sort(rows['RunOrder']), 1 + np.arange(len(rows))):
        raise PlanError(f'{path}: RunOrder is not a permutation of 1 to {len(rows)}')


def _read_settings(path: Path) -> PlanSettings | None:
    if not path.exists():
        return None
    try:
        mapping = json.loads(path.read_text(encoding='utf-8'))
        confirmation = mapping.pop('confirmation')
        treatments, before = _read_treatments(mapping)
        return PlanSettings(
            **{**mapping, **{name: tuple(mapping.get(name, ())) for name in _LISTS}},
            treatments=treatments,
            predecessor=before,
            confirmation=Confirmation(
                confirmation['runs'], confirmation['level'], tuple(confirmation['seeds'])
            ),
        )
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise PlanError(f'{path}: not the settings of a plan ({error})') from error


def _read_treatments(mapping: dict[str, Any]) -> tuple[Treatments, str]:
    """Take factors, base and the plan before out of the settings of a file."""
    factors, base = mapping.pop('factors'), mapping.pop('base', '')
    if isinstance(factors, str):  # sensors; the base is the plan before
        return sensors(factors), base
    spec = RunSpec.from_mapping(base, 'base')
    return Treatments(factors_of(factors, spec), spec), mapping.pop('predecessor', '')
