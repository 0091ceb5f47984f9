# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What a two-level experiment is able to see: power and smallest effect, by formula."""

import numpy as np
from scipy.optimize import brentq
from scipy.stats import f as f_distribution
from scipy.stats import ncf


def power(
    effect: float, runs: int, parameters: int, sigma: float = 1.0, alpha: float = 0.05
) -> float:
    """Return the probability that the test of one effect is significant.

    With orthogonal +-1 columns the F statistic of an effect is noncentral F(1, runs - parameters)
    with noncentrality runs * effect^2 / (4 sigma^2).

    Args:
        effect: Mean response at +1 minus mean response at -1.
        runs: All runs of the experiment, replicates included.
        parameters: Terms of the fitted model with its constant.
        sigma: Standard deviation of one run's response, in the unit of `effect`.
        alpha: Significance level of the test.

    Raises:
        ValueError: No degrees of freedom are left, or sigma or alpha is out of range.
    """
    df = _error_df(runs, parameters)
    if not sigma > 0:
        raise ValueError(f'sigma {sigma}: expected a positive standard deviation')
    if not 0 < alpha < 1:
        raise ValueError(f'alpha {alpha}: expected a probability between 0 and 1')
    noncentrality = runs * effect**2 / (4 * sigma**2)
    critical = f_distribution.isf(alpha, 1, df)
    if noncentrality == 0:
        return alpha
    return float(ncf.sf(critical, 1, df, noncentrality))


def smallest_effect(
    runs: int, parameters: int, sigma: float = 1.0, alpha: float = 0.05, wanted: float = 0.8
) -> float:
    """Return the effect that is found with the wanted power; arguments as for `power`.

    Raises:
        ValueError: No degrees of freedom are left, or `wanted` is not between alpha and 1.
    """
    if not alpha < wanted < 1:
        raise ValueError(f'power {wanted}: expected a probability between alpha {alpha} and 1')
    scale = 2 * sigma / np.sqrt(runs)  # standard error of an effect
    high = scale
    while power(high, runs, parameters, sigma, alpha) < wanted:
        high *= 2
    root = brentq(
        lambda x: power(x, runs, parameters, sigma, alpha) - wanted, 0.0, high, xtol=1e-12
    )
    return float(root)


def replicates_for(
    effect: float,
    cases: int,
    parameters: int,
    sigma: float = 1.0,
    alpha: float = 0.05,
    wanted: float = 0.8,
    limit: int = 1000,
) -> int:
    """Return the fewest replicates of a design that find an effect with the wanted power.

    Raises:
        ValueError: More than `limit` replicates would be needed.
    """
    for replicates in range(1, limit + 1):
        runs = cases * replicates
        if runs > parameters and power(effect, runs, parameters, sigma, alpha) >= wanted:
            return replicates
    raise ValueError(f'effect {effect}: not found with power {wanted} by {limit} replicates')


def _error_df(runs: int, parameters: int) -> int:
    if runs <= parameters:
        raise ValueError(
            f'{runs} runs, {parameters} parameters: no degrees of freedom are left for the error, '
            f'expected at least {parameters + 1} runs'
        )
    return runs - parameters
