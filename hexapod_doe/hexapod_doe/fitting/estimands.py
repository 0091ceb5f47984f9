# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Declared summaries of a case's runs: mean, interquartile mean, mean of the best of m.

Each is a weighted sum of the ordered runs of a case. By jackknife pseudo-values n·T − (n−1)·T₍₋ᵢ₎
it becomes a response per run whose mean is T without its bias, so that every step of the
analysis works on it: for the mean the pseudo-values are the runs themselves.
"""

import re
from collections.abc import Callable
from dataclasses import dataclass
from math import comb

import numpy as np
import pandas as pd

from hexapod_doe.errors import AnalysisError, TableError

Weights = Callable[[int], np.ndarray]


@dataclass(frozen=True)
class Estimand:
    """A summary of the runs of a case."""

    name: str
    description: str
    weights: Weights
    """Weights of the ordered runs, lowest first, for a number of runs."""
    least_runs: int


def estimand(name: str) -> Estimand:
    """Return the estimand called `mean`, `iqm` or `best_of:m`.

    Raises:
        AnalysisError: There is no such estimand.
    """
    if name == 'mean':
        return Estimand(name, 'mean of all runs', lambda n: np.full(n, 1 / n), 1)
    if name == 'iqm':
        return Estimand(name, 'mean of the middle half of the runs', _iqm, 4)
    kind, _, number = name.partition(':')
    if kind != 'best_of' or not re.fullmatch('[1-9][0-9]{0,5}', number):
        raise AnalysisError(f'estimand {name!r}: expected mean, iqm or best_of:m')
    best = int(number)
    return Estimand(
        name, f'expected best of {best} runs', lambda n: best_of_weights(n, best), best + 1
    )


def _iqm(runs: int) -> np.ndarray:
    """Return weights of the exact middle half: the runs at its edges count by their share."""
    position = np.arange(runs)
    share = np.minimum(position + 1, 0.75 * runs) - np.maximum(position, 0.25 * runs)
    return np.clip(share, 0, None) / (0.5 * runs)


def best_of_weights(runs: int, best: int) -> np.ndarray:
    """Return the order-statistic weights of E[max of m]: C(i−1, m−1)/C(n, m)."""
    return np.array([comb(i, best - 1) / comb(runs, best) for i in range(runs)])


def pseudo_values(estimand: Estimand, response: np.ndarray, case: pd.Series) -> np.ndarray:
    """Return the jackknife pseudo-value of each run (n,).

    Raises:
        TableError: A case has too few runs.
    """
    if estimand.name == 'mean':
        return response
    result = np.empty(len(response))
    for number, rows in case.groupby(case).indices.items():
        if len(rows) < estimand.least_runs:
            raise TableError(
                f'case {number} has {len(rows)} runs: {estimand.name} needs '
                f'{estimand.least_runs} of each case'
            )
        result[rows] = _pseudo(estimand.weights, response[rows])
    return result


def _pseudo(weights: Weights, runs: np.ndarray) -> np.ndarray:
    n = len(runs)
    order = np.argsort(runs, kind='stable')
    ordered = runs[order]
    without = np.array([np.delete(ordered, i) @ weights(n - 1) for i in range(n)])
    result = np.empty(n)
    result[order] = n * (ordered @ weights(n)) - (n - 1) * without
    return result
