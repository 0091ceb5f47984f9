# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The analysis of variance of a fit, with adjusted sums of squares, and its variance inflation.

The adjusted sum of squares of a group of terms is what the error grows by without them, all
others kept (type III); in an orthogonal design they add up.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from scipy import stats
from statsmodels.regression.linear_model import OLS

from hexapod_doe.designs.terms import CONSTANT, CURVATURE, letters
from hexapod_doe.fitting.regression import Fit


@dataclass(frozen=True)
class AnovaRow:
    """One source of variation; what does not exist is None."""

    source: str
    df: int
    ss: float
    """Adjusted sum of squares."""
    ms: float | None
    f: float | None
    p: float | None


def anova(fit: Fit) -> tuple[AnovaRow, ...]:
    """Return the table: model, its groups and their terms, error and its parts, total."""
    if not fit.df_error or fit.sse <= 0:
        return ()
    groups = _groups(fit.terms)
    rows = [_row(fit, 'model', [t for t in fit.terms if t != CONSTANT])]
    for name, members in groups:
        rows.append(_row(fit, name, members))
        if members != [CURVATURE]:
            rows += [_row(fit, term, [term]) for term in members]
    if fit.blocks is not None:
        test = fit.blocks
        rows.append(AnovaRow('blocks', test.df, test.ss, test.mean_square, test.f, test.p))
    return (
        *(row for row in rows if row.df),
        AnovaRow('error', fit.df_error, fit.sse, fit.sse / fit.df_error, None, None),
        *_error_parts(fit),
        AnovaRow('total', fit.n - 1, fit.sst, None, None, None),
    )


def vif(fit: Fit) -> dict[str, float]:
    """Return the variance inflation factor of each term: 1 where it is orthogonal to all others.

    (X'X)⁻¹ⱼⱼ·Σ(xⱼ − x̄ⱼ)² = 1/(1 − R²) of its column on the others, blocks included.
    """
    columns = fit.result.model.exog[:, : len(fit.terms)]
    spread = ((columns - columns.mean(axis=0)) ** 2).sum(axis=0)
    values = (fit.root**2).sum(axis=1) * spread
    return {
        term: float(value)
        for term, value in zip(fit.terms, values, strict=True)
        if term != CONSTANT
    }


def _groups(terms: Sequence[str]) -> list[tuple[str, list[str]]]:
    names = {1: 'main effects', 2: 'two-factor interactions'}
    sizes = sorted({len(letters(term)) for term in terms} - {0})
    groups = [
        (names.get(size, f'{size}-factor interactions'),
         [term for term in terms if len(letters(term)) == size])
        for size in sizes
    ]  # fmt: skip
    return [*groups, (CURVATURE, [term for term in terms if term == CURVATURE])]


def _row(fit: Fit, source: str, members: Sequence[str]) -> AnovaRow:
    """Return what the error grows by without some terms, tested against the error."""
    if not members:
        return AnovaRow(source, 0, 0.0, None, None, None)
    if len(members) == 1:  # as by leaving it out, without fitting again
        index = fit.terms.index(members[0])
        ss, df = float(fit.coef[index] ** 2 / (fit.root[index] ** 2).sum()), 1
    else:
        ss, df = _lost(fit, members), len(members)
    f = (ss / df) / (fit.sse / fit.df_error)
    return AnovaRow(source, df, ss, ss / df, f, float(stats.f.sf(f, df, fit.df_error)))


def _lost(fit: Fit, members: Sequence[str]) -> float:
    """Return what the error grows by without some terms."""
    model = fit.result.model
    kept = [i for i in range(model.exog.shape[1]) if i >= len(fit.terms)]
    kept += [i for i, term in enumerate(fit.terms) if term not in members]
    without = OLS(model.endog, model.exog[:, sorted(kept)], hasconst=True).fit()
    return max(float(without.ssr) - fit.sse, 0.0)


def _error_parts(fit: Fit) -> list[AnovaRow]:
    lack = fit.lack_of_fit
    if lack is None:
        return []
    between, within = lack.df_lack_of_fit, lack.df_pure_error
    return [
        AnovaRow(
            'lack of fit', between, lack.ss_lack_of_fit, lack.ss_lack_of_fit / between,
            lack.f, lack.p,
        ),
        AnovaRow(
            'pure error', within, lack.ss_pure_error, lack.ss_pure_error / within, None, None
        ),
    ]  # fmt: skip
