# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The winners of thousands of small campaigns over the same cases, without anything else.

What `analyse` chooses by, for a stack of campaigns at once. Tests hold each winner to that of
`choosing.choice.decide`.
"""

from collections.abc import Mapping
from functools import cached_property

import numpy as np
import pandas as pd
from scipy import special

from hexapod_doe.choosing.failure import failure_threshold
from hexapod_doe.choosing.two_part import EVENTS_PER_TERM
from hexapod_doe.designs.terms import CONSTANT, is_interaction, order
from hexapod_doe.fitting.alias_matrix import without_arbitrary
from hexapod_doe.fitting.elimination import with_parents
from hexapod_doe.fitting.lenth import lenth
from hexapod_doe.fitting.model import corners, estimable_terms, independent_terms, labels
from hexapod_doe.fitting.transform import profile_lambda, shift_for
from hexapod_doe.studies.stacked_fits import (
    Terms,
    eliminate,
    least_squares,
    select_failure,
    sums,
)

TRIMMED = 0.3
"""Share of the runs of a case that the article drops: three of ten."""
_ALPHA = 0.05


class Winners:
    """Chooses by both procedures in stacks of campaigns, each of the same cases."""

    def __init__(self, cases: pd.DataFrame) -> None:
        """Take the coded levels of the cases, each once."""
        self._cases = cases
        self.labels = labels(corners([str(name) for name in cases.columns]))
        self._reduced: dict[tuple[str, ...], tuple[str, ...]] = {}
        self._of_cases: dict[bytes, tuple[str, ...]] = {}

    @cached_property
    def _every(self) -> Terms:
        return Terms(self._cases, without_arbitrary(self._cases, estimable_terms(self._cases)))

    @cached_property
    def _pairs(self) -> Terms:
        terms = without_arbitrary(self._cases, estimable_terms(self._cases, 2))
        return Terms(self._cases, terms)

    def two_part(self, values: np.ndarray) -> np.ndarray:
        """Return the numbers of the winners (b,) by the two-part model, or the final one.

        Args:
            values: Responses (b, cases, runs).
        """
        runs = values.shape[2]
        case = np.repeat(np.arange(values.shape[1]), runs)
        found = [failure_threshold(each.ravel(), case) if runs > 1 else None for each in values]
        limits = np.array([-np.inf if limit is None else limit.value for limit in found])
        failed = values < limits[:, None, None]
        start = np.array([self._success_terms(each) for each in failed])
        apart = failed.any(axis=(1, 2)) & start.any(axis=1)
        result = np.empty(len(values), dtype=int)
        if apart.any():
            result[apart] = self._by_parts(values[apart], failed[apart], start[apart])
        if not apart.all():
            result[~apart] = self._by_final(values[~apart])
        return result

    def article(self, values: np.ndarray) -> np.ndarray:
        """Return the numbers of the winners (b,) by the article's procedure.

        Three runs of ten are dropped, the nearest whole number of others, two left at least.

        Args:
            values: Responses (b, cases, runs).
        """
        runs, terms = values.shape[2], self._every
        worst = max(0, min(int(TRIMMED * runs + 0.5), runs - 2))
        kept = np.sort(values, axis=2)[:, :, worst:]
        start = self._start(kept)
        powered = np.array(
            [
                _powered(each, terms.columns[:, mask])
                for each, mask in zip(kept, start, strict=True)
            ]
        )
        protected = terms.main
        return self._eliminated(powered, start, protected)

    def _success_terms(self, failed: np.ndarray) -> np.ndarray:
        """Return which terms the successes of a campaign begin with, none if they are too few."""
        terms, none = self._pairs, np.zeros(len(self._pairs.names), dtype=bool)
        seen = ~failed.all(axis=1)
        key = seen.tobytes()
        if key not in self._of_cases:
            self._of_cases[key] = independent_terms(
                self._cases.iloc[np.flatnonzero(seen)], terms.names
            )
        names = self._of_cases[key]
        if failed.sum() < 2 or not set(np.array(terms.names)[terms.main]) <= set(names):
            return none
        successes = int((~failed).sum())
        while successes - len(names) < 2:
            highest = max(map(order, names))
            if highest < 2:
                return none
            names = tuple(name for name in names if order(name) < highest)
        return terms.mask(names)

    def _by_parts(self, values: np.ndarray, failed: np.ndarray, start: np.ndarray) -> np.ndarray:
        terms = self._pairs
        total = np.full(values.shape[:2], values.shape[2])
        failures = failed.sum(axis=2)
        events = np.minimum(failures.sum(axis=1), (total - failures).sum(axis=1))
        pairs = events >= EVENTS_PER_TERM * len(terms.names)
        odds = select_failure(terms, failures, total, pairs[:, None] | ~terms.interaction)
        reward = eliminate(terms, *sums(values, ~failed), start, np.zeros_like(terms.main))
        chance = special.expit(odds @ terms.points.T)
        lost = np.where(failed, values, 0).sum(axis=(1, 2)) / failures.sum(axis=1)
        return terms.best((1 - chance) * (reward @ terms.points.T) + chance * lost[:, None])

    def _by_final(self, values: np.ndarray) -> np.ndarray:
        start = self._start(values)
        if values.shape[2] > 1:
            return self._eliminated(values, start, np.zeros_like(self._every.main))
        every = np.ones(values.shape, dtype=bool)
        coef, _, _ = least_squares(self._every, *sums(values, every), start)
        return self._every.best(coef @ self._every.points.T)

    def _eliminated(
        self, values: np.ndarray, start: np.ndarray, protected: np.ndarray
    ) -> np.ndarray:
        every = np.ones(values.shape, dtype=bool)
        coef = eliminate(self._every, *sums(values, every), start, protected)
        return self._every.best(coef @ self._every.points.T)

    def _start(self, values: np.ndarray) -> np.ndarray:
        """Return the terms that a model begins with: all, or what single runs leave (b, terms)."""
        terms = self._every
        start = np.ones((len(values), len(terms.names)), dtype=bool)
        saturated = len(terms.names) == values.shape[1] * values.shape[2]
        if not saturated:
            return start
        for each, mask in zip(values[:, :, 0], start, strict=True):
            coef = np.linalg.solve(terms.columns, each)
            mask[:] = terms.mask(self._active(dict(zip(terms.names, 2 * coef, strict=True))))
        return start

    def _active(self, effects: Mapping[str, float]) -> tuple[str, ...]:
        """Return the main effects and what Lenth's method finds beside them."""
        mains = tuple(name for name in self._every.names if not is_interaction(name))
        others = {name: effect for name, effect in effects.items() if name != CONSTANT}
        found = lenth(others, _ALPHA).clearly_active if len(others) > 2 else ()
        wanted = tuple(dict.fromkeys((*mains, *found)))
        if wanted not in self._reduced:
            terms = with_parents(self._cases, wanted)
            self._reduced[wanted] = terms if len(terms) <= 0.75 * len(effects) else mains
        return self._reduced[wanted]


def _powered(values: np.ndarray, columns: np.ndarray) -> np.ndarray:
    """Return responses (cases, runs) under the power that Box and Cox's method finds.

    The rounding of λ is that of `fitting.transform`; the scale changes no order.
    """
    positive = values + shift_for(values)
    matrix = np.repeat(columns, values.shape[1], axis=0)
    power = np.round(2 * profile_lambda(positive.ravel(), matrix)) / 2
    mean = np.exp(np.log(positive).mean())
    return np.asarray(special.boxcox(positive / mean, power))
