# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Statements about all combinations under one estimand, with intervals that hold.

No term is selected and no equal variance assumed: elimination leaves out small effects whose sum
moves a prediction (its classical 90 % intervals cover 68 % in the study of docs/statistics.md),
and failing runs make the variance differ by case. What a prediction varies by is added up from
the cases, from blocks and from interactions that the model must leave out; its interval is that
of t with Satterthwaite's degrees of freedom, which holds from two runs of a case on.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy import stats

from hexapod_doe.choosing.prediction import rank_descending
from hexapod_doe.fitting.alias_matrix import without_arbitrary
from hexapod_doe.fitting.blocks import BlockTest
from hexapod_doe.fitting.estimands import Estimand, estimand, pseudo_values
from hexapod_doe.fitting.left_out import left_out
from hexapod_doe.fitting.model import corners, estimable_terms, labels, model_matrix
from hexapod_doe.fitting.regression import Fit, ols
from hexapod_doe.records.findings import EstimandResult, Estimate
from hexapod_doe.tables.table import BLOCK, RunTable

STATED = ('mean', 'iqm', 'best_of:3')
_DRAWN = 2.0
"""In the study of docs/statistics.md intervals cover with this, from two runs of a case on."""


@dataclass(frozen=True)
class _Variance:
    """A part of the variance of all predictions (m,), and its degrees of freedom."""

    value: np.ndarray
    df: np.ndarray | float


def estimates(table: RunTable, level: float) -> tuple[EstimandResult, ...]:
    """Return a result for each of the stated estimands that every case has enough runs for.

    In blocks only the mean is stated: what a few blocks share moves ordered runs in ways that no
    variance between their means tells.
    """
    fewest = int(table.rows.groupby('case').size().min())
    known = (estimand(name) for name in (STATED[:1] if table.block_column else STATED))
    return tuple(
        estimate(table, item, level) for item in known if fewest >= max(2, item.least_runs)
    )


def estimate(table: RunTable, item: Estimand, level: float) -> EstimandResult:
    """Estimate all combinations from the terms up to order 2 that the runs can estimate.

    Args:
        table: Runs, two in each case at least.
        item: What is estimated.
        level: Confidence of the intervals.
    """
    terms = without_arbitrary(table.levels, estimable_terms(table.levels, 2, table.all_blocks))
    response = pseudo_values(item, table.values, table.rows['case'])
    fit = ols(table.levels, response, terms, table.all_blocks)
    grid = corners(table.factors)
    fits = model_matrix(grid, terms) @ fit.coef
    parts = _variances(table, fit, grid, response)
    left = left_out(table.levels, fit, grid)
    if left is not None:
        parts.append(_Variance(left.variance, left.df))
    half = _half_width(parts, level)
    names = labels(grid)
    ranking = [names[i] for i in np.argsort(rank_descending(fits))]
    return EstimandResult(
        name=item.name,
        description=item.description,
        terms=terms,
        coef=dict(zip(terms, map(float, fit.coef), strict=True)),
        predictions={
            name: Estimate(float(fits[i]), (float(fits[i] - half[i]), float(fits[i] + half[i])))
            for i, name in enumerate(names)
        },
        ranking=tuple(ranking),
        choice=ranking[0],
    )


def _half_width(parts: Sequence[_Variance], level: float) -> np.ndarray:
    """Return half widths by t with Satterthwaite's degrees of freedom (m,)."""
    total = np.sum([part.value for part in parts], axis=0)
    rest = np.sum([part.value**2 / part.df for part in parts], axis=0)
    df = total**2 / np.maximum(rest, np.finfo(float).tiny)
    return stats.t.ppf((1 + level) / 2, np.maximum(df, 1)) * np.sqrt(total)


def _variances(
    table: RunTable, fit: Fit, grid: pd.DataFrame, response: np.ndarray
) -> list[_Variance]:
    """Return what the predictions vary by.

    Args:
        table: The runs (n).
        fit: The model.
        grid: Coded levels of what is predicted (m rows).
        response: What is estimated, per run (n,).
    """
    points = model_matrix(grid, fit.terms)
    block = _complete_blocks(table)
    if fit.blocks is not None and block is None:
        return _within_blocks(fit, fit.blocks, points)
    weights = points @ np.linalg.pinv(model_matrix(table.levels, fit.terms))
    case = table.rows.groupby('case').ngroup().to_numpy()
    if block is None:
        return [_within_cases(weights, response, case, 0)[0]]
    means = np.bincount(block, response) / np.bincount(block)
    within, mean_square = _within_cases(weights, response - means[block], case, 1)
    return [within, _between_blocks(means, mean_square / len(block), len(points))]


def _within_blocks(fit: Fit, blocks: BlockTest, points: np.ndarray) -> list[_Variance]:
    """Return the parts of blocks that don't hold every case alike: one variance for all runs."""
    error = (fit.s or 0) ** 2
    value = blocks.variance(error) / blocks.count
    share = value / (blocks.mean_square / blocks.runs / blocks.count) if value else 1.0
    between = np.full(len(points), value)
    return [
        _Variance(error * fit.unscaled_variance(points), float(fit.df_error)),
        _Variance(between, blocks.df * share**2),
    ]


def _within_cases(
    weights: np.ndarray, response: np.ndarray, case: np.ndarray, shared: int
) -> tuple[_Variance, float]:
    """Return the variance by that within each case, and its mean square.

    A case of a few runs hardly tells its variance, and one that saw no failure far too little:
    each is drawn to the mean over cases with the weight of `_DRAWN` degrees of freedom.

    Args:
        weights: Of each run in each prediction (m, n).
        response: Of each run, free of blocks (n,).
        case: Of each run (n,).
        shared: 1 if block means, which all cases share, were taken out of the response.
    """
    count = np.bincount(case)
    means = np.bincount(case, response) / count
    variance = np.bincount(case, (response - means[case]) ** 2) / (count - 1)
    variance /= 1 - shared / len(count)
    own, mean_square = count - 1, float(np.average(variance, weights=count - 1))
    drawn = (own * variance + _DRAWN * mean_square) / (own + _DRAWN)
    parts = np.array([np.bincount(case, row**2) for row in weights]) * drawn
    value = parts.sum(axis=1)
    rest = (parts**2 / (own + _DRAWN)).sum(axis=1)
    df = value**2 / np.maximum(rest, np.finfo(float).tiny)
    return _Variance(value, np.clip(df, 1, own.sum())), mean_square


def _complete_blocks(table: RunTable) -> np.ndarray | None:
    """Return the number of each run's block if every case is in all blocks alike (n,)."""
    if not table.block_column:
        return None
    counts = pd.crosstab(table.rows['case'], table.rows[BLOCK])
    alike = counts.gt(0) & counts.eq(counts.iloc[:, 0], axis=0)
    return pd.factorize(table.rows[BLOCK])[0] if alike.all(axis=None) else None


def _between_blocks(means: np.ndarray, error: float, points: int) -> _Variance:
    """Return the variance of the mean over blocks, which all predictions share.

    σ²_block/B, from the variance of the block means less what runs of one block explain of it.

    Args:
        means: Of the blocks (B,).
        error: Variance of the mean of all runs by that within cases.
        points: How many predictions there are.
    """
    total = float(means.var(ddof=1)) / len(means)
    value = max(0.0, total - error)
    df = (len(means) - 1) * (value / total) ** 2 if value else 1.0
    return _Variance(np.full(points, value), df)
