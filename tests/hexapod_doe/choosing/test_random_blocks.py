# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Seeds are a sample: means and new runs carry the variance between them, differences do not."""

import numpy as np
import pandas as pd
import pytest
from hexapod_doe.choosing.draws import coefficient_draws
from hexapod_doe.choosing.estimate import estimates
from hexapod_doe.choosing.prediction import half_widths
from hexapod_doe.designs.design import fraction
from hexapod_doe.fitting.blocks import block_basis
from hexapod_doe.fitting.model import corners, model_matrix
from hexapod_doe.fitting.regression import Fit, ols
from hexapod_doe.tables.table import BLOCK, RESPONSE, RunTable, build_rows
from scipy import stats

SEEDS, BETWEEN, NOISE = 8, 30.0, 20.0
TERMS = ('1', *'ABCDEFG')


def campaign(rng: np.random.Generator) -> tuple[pd.DataFrame, np.ndarray, np.ndarray]:
    """Levels, seeds and responses of 300 + 50 C with the same random seeds in every case."""
    design = fraction('eighth')
    levels = pd.DataFrame(np.tile(design.levels, (SEEDS, 1)), columns=list(design.factors))
    seed = np.repeat(np.arange(SEEDS), design.cases)
    luck = rng.normal(0, BETWEEN, SEEDS)
    return levels, seed, 300 + 50 * levels['C'] + luck[seed] + rng.normal(0, NOISE, len(levels))


def fits(number: int) -> list[Fit]:
    rng = np.random.default_rng(4)
    made = (campaign(rng) for _ in range(number))
    return [ols(levels, y.to_numpy(), TERMS, block_basis(seed)) for levels, seed, y in made]


def test_the_grand_mean_of_random_blocks() -> None:
    # The mean over blocks has the standard error of the mean of the block means, and its degrees
    # of freedom: 3 - 1. Their variance is MS_block/2, here well above that of the error.
    levels = pd.DataFrame({'A': [-1, 1] * 3})
    y = np.array([1.0, 2.0, 5.0, 6.5, 9.0, 9.5])
    fit = ols(levels, y, ('1', 'A'), block_basis(np.repeat([0, 1, 2], 2)))
    means = y.reshape(3, 2).mean(axis=1)
    expected = stats.t.ppf(0.95, 2) * np.sqrt(means.var(ddof=1) / 3)
    assert half_widths(fit, np.array([[1.0, 0.0]]), 0.9) == pytest.approx(expected)


def test_blocks_that_do_not_differ_add_nothing() -> None:
    levels = pd.concat([corners('AB')] * 2, ignore_index=True)
    y = np.array([1.0, 5.0, 2.0, 8.0, 5.0, 1.0, 8.0, 2.0])  # both blocks sum to 16
    block = np.repeat([0, 1], 4)
    fit = ols(levels, y, ('1', 'A'), block_basis(block))
    point = model_matrix(levels.iloc[:1], fit.terms)
    expected = stats.t.ppf(0.95, 5) * fit.s * np.sqrt(2 / 8)
    assert half_widths(fit, point, 0.9) == pytest.approx(expected)


def test_intervals_cover_the_mean_over_seeds_and_new_runs_of_new_seeds() -> None:
    rng = np.random.default_rng(5)
    truth = 350.0  # of the set with C alone
    point = model_matrix(corners('ABCDEFG').iloc[[4]], TERMS)
    found: dict[str, list[bool]] = {'mean': [], 'run': [], 'drawn mean': [], 'drawn run': []}
    for fit in fits(600):
        new_run = truth + rng.normal(0, np.hypot(BETWEEN, NOISE))
        centre = float((point @ fit.coef)[0])
        coef, s = coefficient_draws(fit, 400, rng)
        drawn = (coef @ point.T)[:, 0]
        for name, target, runs, values in (
            ('mean', truth, None, drawn),
            ('run', new_run, 1, drawn + s * rng.standard_normal(400)),
        ):
            half = float(half_widths(fit, point, 0.9, runs)[0])
            found[name].append(abs(target - centre) <= half)
            low, high = np.quantile(values, [0.05, 0.95])
            found[f'drawn {name}'].append(low <= target <= high)
    assert {name: np.mean(hits) for name, hits in found.items()} == pytest.approx(
        dict.fromkeys(found, 0.9), abs=0.03
    )


def test_differences_between_sets_have_no_part_in_it() -> None:
    (fit,) = fits(1)
    coef, _ = coefficient_draws(fit, 4000, np.random.default_rng(6))
    assert coef[:, TERMS.index('C')].std() == pytest.approx(fit.se[TERMS.index('C')], rel=0.05)
    assert coef[:, 0].std() > 3 * fit.se[0]


def test_the_bootstrap_draws_whole_seeds() -> None:
    covered = []
    rng = np.random.default_rng(7)
    for _ in range(60):
        levels, seed, y = campaign(rng)
        rows, _ = build_rows(levels.assign(**{RESPONSE: y, BLOCK: seed}), list('ABCDEFG'))
        table = RunTable('', '', 'y', tuple('ABCDEFG'), rows, block_column='seed')
        mean = estimates(table, 0.9)[0].predictions['C'].ci
        covered.append(mean[0] <= 350 <= mean[1])
    assert np.mean(covered) == pytest.approx(0.9, abs=0.08)  # its error is 0.04
