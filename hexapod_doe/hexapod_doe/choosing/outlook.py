# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What a choice is made from: one model's values of all combinations, and draws of them.

Decisions (ranking, probabilities of being best or not worse) come from the selected model: in
the study of docs/statistics.md its probabilities are true to the frequencies. Intervals come
from the model before selection, whose draws cover; selection leaves out small effects and with
them a part of the error.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pandas as pd

from hexapod_doe.choosing.draws import (
    back_draws,
    coefficient_draws,
    draw_count,
    equal_within,
    prediction_draws,
)
from hexapod_doe.choosing.prediction import back, rank_descending
from hexapod_doe.choosing.two_part import Parts
from hexapod_doe.designs.terms import order
from hexapod_doe.fitting.dispersion import Dispersion, dispersion, relative_deviation
from hexapod_doe.fitting.left_out import left_out
from hexapod_doe.fitting.model import corners, labels, model_matrix
from hexapod_doe.fitting.regression import Fit, ols
from hexapod_doe.fitting.transform import Transform
from hexapod_doe.modelling.pipeline import Pipeline


@dataclass(frozen=True)
class Stated:
    """What is stated with intervals, by the model before selection."""

    fits: np.ndarray
    """Values (2^k,)."""
    draws: np.ndarray
    """Draws of them (draws, 2^k)."""
    future_mean: Callable[[int], np.ndarray]
    """Draws of the mean of m new runs of each combination, from m."""


@dataclass(frozen=True)
class Outlook:
    """Values of the 2^k combinations by one model."""

    model: str
    labels: list[str]
    fits: np.ndarray
    """Values by the selected model (2^k,)."""
    draws: np.ndarray | None
    """Draws of them (draws, 2^k); None where the model leaves no error."""
    stated: Stated | None
    terms: tuple[str, ...]
    coef: np.ndarray
    value: Callable[[np.ndarray], np.ndarray]
    """Value from the linear predictor of `terms` (2^k,)."""
    levels: pd.DataFrame
    response: np.ndarray
    """The rows that the linear predictor was fitted to (n,)."""
    blocks: np.ndarray
    """Basis of the differences between their blocks (n, b)."""
    spread: Callable[[np.ndarray], np.ndarray]
    """Draws of the values from draws of the linear predictor (draws, 2^k), for intervals."""
    decide: Callable[[np.ndarray], np.ndarray]
    """The same by the selected model, for the order of the combinations."""
    dispersion: Dispersion | None
    """Whether the spread of the runs differs by factor; None with too few to tell."""

    @property
    def ranking(self) -> tuple[str, ...]:
        """Labels, best first."""
        return tuple(self.labels[i] for i in np.argsort(rank_descending(self.fits)))

    @property
    def choice_rule(self) -> str:
        """Why the first of the ranking comes first, in a sentence."""
        rule = f'highest expected response by the {self.model}'
        behind = np.nanmax(self.fits) - self.fits
        equal = int((behind <= equal_within(self.fits[None])[0]).sum())
        return rule if equal == 1 else f'{rule}; of {equal} equal sets the one with fewest letters'


def final_outlook(state: Pipeline, rng: np.random.Generator) -> Outlook:
    """Return the outlook of a pipeline's final model."""
    fit, transform = state.last, state.transform
    grid = corners(state.table.factors)
    points = model_matrix(grid, fit.terms)
    count = draw_count(len(points))
    known = fit.s is not None
    before = _unselected(state)
    found = dispersion(state.levels, before, state.options.alpha)
    return Outlook(
        model='final model',
        labels=labels(grid),
        fits=back(points @ fit.coef, transform),
        draws=prediction_draws(fit, points, transform, count, rng) if known else None,
        stated=_stated(before, state, count, rng, found) if known else None,
        terms=fit.terms,
        coef=fit.coef,
        value=lambda eta: back(eta, transform),
        levels=state.levels,
        response=state.steps[-1].response,
        blocks=state.blocks,
        spread=lambda eta: back_draws(eta, transform),
        decide=lambda eta: back_draws(eta, transform),
        dispersion=found,
    )


def _unselected(state: Pipeline) -> Fit:
    """Return the fit before elimination, without terms of order 3 and more."""
    if not state.dropped:
        return state.last
    last, before = state.steps[-1], state.steps[-2].fit
    terms = tuple(term for term in before.terms if order(term) <= 2)
    return ols(state.levels, last.response, terms, state.blocks)


def _stated(
    fit: Fit, state: Pipeline, count: int, rng: np.random.Generator, found: Dispersion | None
) -> Stated:
    grid = corners(state.table.factors)
    points = model_matrix(grid, fit.terms)
    ratio = relative_deviation(grid, state.levels, fit, found)
    left = left_out(state.levels, fit, grid)
    coef, s = coefficient_draws(fit, count, rng, found)
    eta = coef @ points.T + (0 if left is None else left.draw(count, rng))
    return Stated(
        fits=back(points @ fit.coef, state.transform),
        draws=back_draws(eta, state.transform),
        future_mean=lambda runs: _future_mean(eta, s[:, None] * ratio, state.transform, runs, rng),
    )


def _future_mean(
    eta: np.ndarray,
    deviation: np.ndarray,
    transform: Transform | None,
    runs: int,
    rng: np.random.Generator,
) -> np.ndarray:
    total = np.zeros_like(eta)
    for _ in range(runs):
        total += back_draws(eta + deviation * rng.standard_normal(eta.shape), transform)
    return total / runs


def two_part_outlook(selected: Parts, unselected: Parts, rng: np.random.Generator) -> Outlook:
    """Return the outlook of a two-part model."""
    pi, _, expected = selected.point()
    grid = corners(selected.factors)
    count = draw_count(len(grid))
    draws = unselected.draw(count, rng)
    return Outlook(
        model='two-part model',
        labels=labels(grid),
        fits=expected,
        draws=selected.draw(count, rng).expected,
        stated=Stated(
            fits=unselected.point()[2],
            draws=draws.expected,
            future_mean=lambda runs: draws.future_mean(runs, rng),
        ),
        terms=selected.success.terms,
        coef=selected.success.coef,
        value=lambda eta: (1 - pi) * eta + pi * selected.failed.mean(),
        levels=selected.levels,
        response=selected.response,
        blocks=selected.blocks,
        spread=lambda eta: unselected.draw(len(eta), rng).mixed_with(eta),
        decide=lambda eta: selected.draw(len(eta), rng).mixed_with(eta),
        dispersion=unselected.dispersion,
    )
