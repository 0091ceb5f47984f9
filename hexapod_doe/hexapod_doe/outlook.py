# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What a choice is made from: one model's values of all combinations, and draws of them."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from hexapod_doe.draws import coefficient_draws, draw_count, prediction_draws
from hexapod_doe.model import corners, labels, model_matrix
from hexapod_doe.pipeline import Pipeline
from hexapod_doe.prediction import back, rank_descending
from hexapod_doe.two_part import Parts


@dataclass(frozen=True)
class Outlook:
    """Values of the 2^k combinations by one model."""

    model: str
    labels: list[str]
    fits: np.ndarray
    """Point values (2^k,)."""
    draws: np.ndarray | None
    """Draws of the values (draws, 2^k); None where the model leaves no error."""
    future_mean: Callable[[int], np.ndarray] | None
    """Draws of the mean of m new runs, from m."""
    terms: tuple[str, ...]
    coef: np.ndarray
    value: Callable[[np.ndarray], np.ndarray]
    """Value from the linear predictor of `terms` (2^k,)."""

    @property
    def ranking(self) -> tuple[str, ...]:
        """Labels, best first."""
        return tuple(self.labels[i] for i in np.argsort(rank_descending(self.fits)))


def final_outlook(state: Pipeline, rng: np.random.Generator) -> Outlook:
    """Return the outlook of a pipeline's final model."""
    fit, transform = state.last, state.transform
    grid = corners(state.table.factors)
    points = model_matrix(grid, fit.terms)
    count = draw_count(len(points))

    def future_mean(runs: int) -> np.ndarray:
        coef, s = coefficient_draws(fit, count, rng)
        eta = coef @ points.T
        noise = rng.standard_normal((runs, *eta.shape)) * s[:, None]
        values = back(eta + noise, transform)
        floor = 0.0 if transform is None else -transform.shift
        return np.nan_to_num(values, nan=floor).mean(axis=0)

    known = fit.s is not None
    return Outlook(
        model='final model',
        labels=labels(grid),
        fits=back(points @ fit.coef, transform),
        draws=prediction_draws(fit, points, transform, count, rng) if known else None,
        future_mean=future_mean if known else None,
        terms=fit.terms,
        coef=fit.coef,
        value=lambda eta: back(eta, transform),
    )


def two_part_outlook(parts: Parts, stated: Parts, rng: np.random.Generator) -> Outlook:
    """Return the outlook of the selected two-part model.

    Values and their draws come from the selected parts; future runs from the stated ones, whose
    intervals hold.
    """
    pi, _, expected = parts.point()
    grid = corners(parts.factors)
    count = draw_count(len(grid))
    return Outlook(
        model='two-part model',
        labels=labels(grid),
        fits=expected,
        draws=parts.draw(count, rng).expected,
        future_mean=lambda runs: stated.draw(count, rng).future_mean(runs, rng),
        terms=parts.success.terms,
        coef=parts.success.coef,
        value=lambda eta: (1 - pi) * eta + pi * parts.failed.mean(),
    )
