# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Statements about all combinations under one estimand, with intervals that hold.

No term is selected and no equal variance assumed: elimination leaves out small effects whose sum
moves a prediction (its classical 90 % intervals cover 68 % in the study of docs/statistics.md),
and failing runs make the variance differ by case.
"""

import numpy as np
import pandas as pd
from scipy import stats

from hexapod_doe.analysis.findings import EstimandResult, Estimate
from hexapod_doe.choosing.estimands import Estimand, estimand, pseudo_values
from hexapod_doe.choosing.prediction import rank_descending
from hexapod_doe.fitting.model import corners, estimable_terms, labels, model_matrix
from hexapod_doe.tables.table import BLOCK, RunTable

STATED = ('mean', 'iqm', 'best_of:3')
RESAMPLES = 2000


def estimates(
    table: RunTable, level: float, rng: np.random.Generator
) -> tuple[EstimandResult, ...]:
    """Return a result for each of the stated estimands that every case has enough runs for."""
    fewest = int(table.rows.groupby('case').size().min())
    known = (estimand(name) for name in STATED)
    return tuple(
        estimate(table, item, level, rng) for item in known if fewest >= max(2, item.least_runs)
    )


def estimate(
    table: RunTable, item: Estimand, level: float, rng: np.random.Generator
) -> EstimandResult:
    """Estimate all combinations from the terms up to order 2 that the runs can estimate.

    Args:
        table: Runs, two in each case at least.
        item: What is estimated.
        level: Confidence of the intervals.
        rng: For the resamples.
    """
    everything = np.ones(len(table.rows), dtype=bool)
    terms = estimable_terms(table.levels, 2, table.block_basis(everything))
    inverse = np.linalg.pinv(model_matrix(table.levels, terms))
    response = pseudo_values(item, table.values, table.rows['case'])
    grid = corners(table.factors)
    weights = model_matrix(grid, terms) @ inverse
    fits = weights @ response
    case = table.rows.groupby('case').ngroup().to_numpy()
    if item.name == 'mean':
        low, high = _bootstrap(weights, response, case, _complete_blocks(table), level, rng)
    else:
        low, high = _within_cases(weights, response, case, level)
    names = labels(grid)
    ranking = [names[i] for i in np.argsort(rank_descending(fits))]
    return EstimandResult(
        name=item.name,
        description=item.description,
        terms=terms,
        coef=dict(zip(terms, map(float, inverse @ response), strict=True)),
        resamples=RESAMPLES if item.name == 'mean' else 0,
        predictions={
            name: Estimate(float(fits[i]), (float(low[i]), float(high[i])))
            for i, name in enumerate(names)
        },
        ranking=tuple(ranking),
        choice=ranking[0],
    )


def _complete_blocks(table: RunTable) -> np.ndarray | None:
    """Return the number of each run's block if every case has one run of every block (n,)."""
    if not table.block_column:
        return None
    counts = pd.crosstab(table.rows['case'], table.rows[BLOCK])
    return pd.factorize(table.rows[BLOCK])[0] if (counts == 1).all(axis=None) else None


def _bootstrap(
    weights: np.ndarray,
    response: np.ndarray,
    case: np.ndarray,
    block: np.ndarray | None,
    level: float,
    rng: np.random.Generator,
) -> tuple[np.ndarray, np.ndarray]:
    """Return expanded percentile intervals, resampling the runs within each case.

    Where every case has a run of every block, blocks are resampled, the same in all cases.
    The percentile α' = Φ(−√(n/(n−1))·t₍₁₋α/₂; n−1₎) makes up for the small n of a case
    (Hesterberg, The American Statistician 69, 2015).
    """
    cases = [np.flatnonzero(case == number) for number in range(case.max() + 1)]
    if block is None:
        picks = [rng.choice(rows, (RESAMPLES, len(rows))) for rows in cases]
    else:
        shared = rng.choice(block.max() + 1, (RESAMPLES, block.max() + 1))
        picks = [rows[np.argsort(block[rows])][shared] for rows in cases]
    means = np.array([response[pick].mean(axis=1) for pick in picks])
    draws = means.T @ np.array([weights[:, rows].sum(axis=1) for rows in cases])
    fewest = min(map(len, cases))
    t = stats.t.ppf((1 + level) / 2, fewest - 1)
    tail = stats.norm.cdf(-np.sqrt(fewest / (fewest - 1)) * t)
    low, high = np.quantile(draws, [tail, 1 - tail], axis=0)
    return low, high


def _within_cases(
    weights: np.ndarray, response: np.ndarray, case: np.ndarray, level: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return t intervals by the variance within each case and Satterthwaite's df."""
    count = np.bincount(case)
    means = np.bincount(case, response) / count
    variance = np.bincount(case, (response - means[case]) ** 2) / (count - 1)
    squared = np.array([np.bincount(case, row**2) for row in weights])
    parts = squared * variance
    total = parts.sum(axis=1)
    df = total**2 / np.maximum((parts**2 / (count - 1)).sum(axis=1), np.finfo(float).tiny)
    half = stats.t.ppf((1 + level) / 2, np.maximum(df, 1)) * np.sqrt(total)
    fits = weights @ response
    return fits - half, fits + half
