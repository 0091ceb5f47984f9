# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Turns fits into records: steps, removals and main effects."""

from collections.abc import Mapping, Sequence

import numpy as np

from hexapod_doe.designs.terms import CONSTANT
from hexapod_doe.fitting.alias_matrix import partial_aliases, with_partial_aliases
from hexapod_doe.fitting.anova import anova, vif
from hexapod_doe.fitting.elimination import Dropped
from hexapod_doe.fitting.model import alias_strings, estimable_terms
from hexapod_doe.fitting.regression import Fit, ols
from hexapod_doe.modelling.pipeline import FittedStep
from hexapod_doe.records.results import MainEffect, Removal, Step
from hexapod_doe.tables.table import RunTable


def step_record(step: FittedStep, aliases: Mapping[str, str]) -> Step:
    """Return the record of a fitted step."""
    fit, terms = step.fit, step.fit.terms
    blank = np.full(len(terms), np.nan)
    se = blank if fit.se is None else fit.se
    return Step(
        name=step.name,
        description=step.description,
        scale='transformed' if step.transformed else 'response',
        n=fit.n,
        terms=terms,
        aliases={term: aliases[term] for term in terms},
        coef=_map(terms, fit.coef),
        se=_map(terms, se),
        t=_map(terms, blank if fit.t is None else fit.t),
        p=_map(terms, blank if fit.p is None else fit.p),
        effects=_map(terms, 2 * fit.coef, constant=False),
        se_effects=_map(terms, 2 * se, constant=False),
        r2=fit.r2,
        r2_adj=fit.r2_adj,
        r2_pred=fit.r2_pred,
        press=fit.press,
        r2_pred_cases=fit.r2_pred_cases,
        press_cases=fit.press_cases,
        s=fit.s,
        df_error=fit.df_error,
        sse=fit.sse,
        sst=fit.sst,
        vif=vif(fit),
        anova=anova(fit),
        lack_of_fit=fit.lack_of_fit,
        blocks=fit.blocks,
        rows=tuple(map(int, step.rows)),
        response=_tuple(step.response),
        fitted=_tuple(fit.fitted),
        residuals=_tuple(fit.residuals),
        leverage=_tuple(fit.leverage),
        studentized=tuple(_number(value) for value in fit.studentized),
    )


def removals(dropped: Sequence[Dropped], aliases: Mapping[str, str]) -> tuple[Removal, ...]:
    """Return the elimination trace with alias strings."""
    return tuple(
        Removal(step, item.term, aliases[item.term], item.p, item.s, item.r2, item.r2_adj)
        for step, item in enumerate(dropped, start=1)
    )


def aliases_of(
    table: RunTable, steps: Sequence[FittedStep], dropped: Sequence[Dropped]
) -> dict[str, str]:
    """Return the alias string of every term that any step fitted or dropped."""
    terms = dict.fromkeys(term for step in steps for term in step.fit.terms)
    terms |= dict.fromkeys(item.term for item in dropped)
    partial = partial_aliases(table.levels, steps[0].fit.terms)
    return {
        term: with_partial_aliases(text, partial.get(term, {}))
        for term, text in alias_strings(table.levels, terms).items()
    }


def main_effects(table: RunTable, first: Fit) -> tuple[MainEffect, ...]:
    """Compare the response with and without each factor.

    Args:
        table: The runs, none dropped.
        first: The first model, fitted to all of them.
    """
    if not set(table.factors) <= set(first.terms):
        mains = estimable_terms(table.levels, 1, table.all_blocks)
        first = ols(table.levels, table.values, mains, table.all_blocks)
    return tuple(_main_effect(table, first, name) for name in table.factors)


def _main_effect(table: RunTable, fit: Fit, name: str) -> MainEffect:
    level, response = table.rows[name], table.values
    with_, without = response[level > 0], response[level < 0]
    fitted, errors = _fitted_means(fit, name)
    return MainEffect(
        factor=name,
        fitted_with=fitted[0],
        fitted_without=fitted[1],
        se_fitted_with=errors[0],
        se_fitted_without=errors[1],
        effect=float(with_.mean() - without.mean()) if fitted[2] is None else fitted[2],
        se_effect=errors[2],
        mean_with=float(with_.mean()),
        mean_without=float(without.mean()),
        se_mean_with=_standard_error(with_),
        se_mean_without=_standard_error(without),
    )


def _fitted_means(fit: Fit, name: str) -> tuple[list[float | None], list[float | None]]:
    """Return the fitted means with and without a factor, their difference, and all their errors.

    Over all combinations of the other factors the other terms average to zero.
    """
    nothing: list[float | None] = [None] * 3
    if name not in fit.terms:
        return nothing, nothing
    points = np.zeros((3, len(fit.terms)))
    points[:2, fit.terms.index(CONSTANT)] = 1
    points[:, fit.terms.index(name)] = [1, -1, 2]
    errors = nothing
    if fit.s is not None:
        errors = list(map(float, fit.s * np.sqrt(fit.unscaled_variance(points))))
    return list(map(float, points @ fit.coef)), errors


def _standard_error(values: np.ndarray) -> float | None:
    return float(values.std(ddof=1) / np.sqrt(len(values))) if len(values) > 1 else None


def _map(terms: Sequence[str], values: np.ndarray, constant: bool = True) -> dict[str, float]:
    return {
        term: float(value)
        for term, value in zip(terms, values, strict=True)
        if constant or term != CONSTANT
    }


def _tuple(values: np.ndarray) -> tuple[float, ...]:
    return tuple(map(float, values))


def _number(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None
