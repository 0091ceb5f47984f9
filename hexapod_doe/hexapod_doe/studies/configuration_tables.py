# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What the table of a study of configurations says: each row's figures, each factor's effect."""

from collections.abc import Sequence

import pandas as pd


def last_of_each(results: pd.DataFrame) -> pd.DataFrame:
    """Return the line of each training's end."""
    return results[results['episode'] == results['episode'].max()]


def figures(results: pd.DataFrame, failure: float) -> pd.DataFrame:
    """Return a line per row and set: trainings, their returns, failures and processor time.

    Args:
        results: Table of a study.
        failure: A training whose agent earns less has failed.
    """
    groups = last_of_each(results).groupby(['row', 'sensors'], sort=False)
    found = groups.agg(
        trainings=('seed', 'size'),
        mean=('return', 'mean'),
        deviation=('return', 'std'),
        least=('return', 'min'),
        failed=('return', lambda returns: int((returns < failure).sum())),
        offset=('offset', 'mean'),
        cpu_s=('cpu_s', 'mean'),
    )
    return found.reset_index()


def effects(results: pd.DataFrame, factors: Sequence[str]) -> pd.DataFrame:
    """Return what the high level of each factor adds to return and processor time, set by set."""
    ends = last_of_each(results)
    lines = [
        {
            'factor': factor,
            'sensors': sensors,
            'return': _difference(part, number, 'return'),
            'cpu_s': _difference(part, number, 'cpu_s'),
        }
        for number, factor in enumerate(factors)
        for sensors, part in ends.groupby('sensors', sort=False)
    ]
    return pd.DataFrame(lines, columns=['factor', 'sensors', 'return', 'cpu_s'])


def _difference(part: pd.DataFrame, factor: int, column: str) -> float:
    high = part['row'].str[factor] == '+'
    return float(part.loc[high, column].mean() - part.loc[~high, column].mean())
