# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The recommended combination, by the two-part model where runs failed, and its record.

`decide` finds the choice alone, as a small part of the whole analysis; `expected_loss` says what
it may cost.
"""

from dataclasses import dataclass

import numpy as np

from hexapod_doe.choosing.averaging import predictor_draws
from hexapod_doe.choosing.draws import draw_count, interval_of
from hexapod_doe.choosing.failure import Threshold, failure_threshold
from hexapod_doe.choosing.outlook import Outlook, final_outlook, two_part_outlook
from hexapod_doe.choosing.two_part import Parts, fit_parts, select_parts
from hexapod_doe.fitting.logistic import lack_of_fit
from hexapod_doe.fitting.model import corners, labels, model_matrix
from hexapod_doe.modelling.pipeline import run
from hexapod_doe.records.findings import Estimate, TwoPart
from hexapod_doe.records.options import Options
from hexapod_doe.tables.table import RunTable


@dataclass(frozen=True)
class Failures:
    """The failures of a campaign, modelled."""

    record: TwoPart
    outlook: Outlook
    failed: np.ndarray
    """Which rows failed (n,)."""


@dataclass(frozen=True)
class _BothParts:
    """The two-part model before and after elimination."""

    threshold: Threshold
    stated: Parts
    selected: Parts


def model_failures(table: RunTable, options: Options, rng: np.random.Generator) -> Failures | None:
    """Model the failures; None if no run failed by the rule, or too few to be modelled."""
    found = _both_parts(table, options)
    if found is None:
        return None
    outlook = two_part_outlook(found.selected, found.stated, rng)
    record = _record(
        table, found.threshold, found.stated, found.selected, outlook, options.level, rng
    )
    return Failures(record, outlook, table.values < found.threshold.value)


def decide(table: RunTable, options: Options) -> Outlook:
    """Return what `analyse` chooses from, without all else that it finds.

    Raises:
        TableError: The table does not allow what the options ask for.
        AliasedTermsError: The named terms cannot be told apart.
        AnalysisError: An option cannot be read.
    """
    rng = np.random.default_rng(options.seed)
    found = None if options.article else _both_parts(table, options)
    if found is not None:
        return two_part_outlook(found.selected, found.stated, rng)
    return final_outlook(run(table, options.as_article() if options.article else options), rng)


def expected_loss(outlook: Outlook, seed: int) -> float | None:
    """Return the reward that the choice is expected to lose against the best combination.

    The mean over draws of how far the choice lies below the best of the same draw, in units of
    the response; the larger one of two kinds of draws. Those of the model before selection know
    of small effects, which selection takes for none, and those averaged over models of the other
    names that confounded effects may have. The draws of the selected model, which the order of
    the combinations comes from, say several times too little (docs/statistics.md).

    Args:
        outlook: What the choice is made from.
        seed: Of the draws.

    Returns:
        None where the model leaves no error.
    """
    if outlook.stated is None:
        return None
    rng = np.random.default_rng(seed)
    eta = predictor_draws(outlook.levels, outlook.response, rng, outlook.blocks)
    chosen = outlook.labels.index(outlook.ranking[0])
    kinds = (outlook.stated.draws, outlook.spread(eta))
    return max(float((np.nanmax(each, axis=1) - each[:, chosen]).mean()) for each in kinds)


def _both_parts(table: RunTable, options: Options) -> _BothParts | None:
    case = table.rows['case'].to_numpy()
    threshold = failure_threshold(table.values, case, options.failure_threshold)
    stated = None if threshold is None else fit_parts(table, threshold.value, options.alpha)
    if threshold is None or stated is None:
        return None
    selected = select_parts(table, stated, threshold.value, options.alpha)
    return _BothParts(threshold, stated, selected)


def _record(
    table: RunTable,
    threshold: Threshold,
    stated: Parts,
    selected: Parts,
    outlook: Outlook,
    level: float,
    rng: np.random.Generator,
) -> TwoPart:
    names = labels(corners(table.factors))
    pi, mu, expected = stated.point()
    draws = stated.draw(draw_count(len(names)), rng)
    run_low, run_high = interval_of(draws.future_mean(1, rng), level)
    error = np.sqrt(np.diag(stated.failure.covariance))
    failed_rows = table.values < threshold.value
    failed = table.rows['label'][failed_rows]

    def estimates(fits: np.ndarray, drawn: np.ndarray) -> dict[str, Estimate]:
        low, high = interval_of(drawn, level)
        return {
            name: Estimate(float(fits[i]), (float(low[i]), float(high[i])))
            for i, name in enumerate(names)
        }

    return TwoPart(
        threshold=threshold.value,
        threshold_rule=threshold.rule,
        runs=len(table.rows),
        failures=len(failed),
        failures_by_case={
            str(label): int((failed == label).sum()) for label in table.rows['label'].unique()
        },
        cases_without_success=tuple(
            sorted(set(table.rows['label']) - set(table.rows['label'][~failed_rows]))
        ),
        failure_terms=stated.failure_terms,
        failure_coef=dict(zip(stated.failure_terms, map(float, stated.failure.coef), strict=True)),
        failure_se=dict(zip(stated.failure_terms, map(float, error), strict=True)),
        failure_lack_of_fit=lack_of_fit(
            stated.failure.probability(model_matrix(table.levels, stated.failure_terms)),
            failed_rows.astype(float),
            table.rows.groupby('case').ngroup().to_numpy(),
            len(stated.failure_terms),
        ),
        success_terms=stated.success.terms,
        success_coef=dict(zip(stated.success.terms, map(float, stated.success.coef), strict=True)),
        dispersion=stated.dispersion,
        mean_failed=float(stated.failed.mean()),
        p_failure=estimates(pi, draws.pi),
        reward_success=estimates(mu, draws.mu),
        expected=estimates(expected, draws.expected),
        run_interval={
            name: (float(run_low[i]), float(run_high[i])) for i, name in enumerate(names)
        },
        selected_failure_terms=selected.failure_terms,
        selected_success_terms=selected.success.terms,
        selected=dict(zip(names, map(float, outlook.fits), strict=True)),
        ranking=outlook.ranking,
        choice=outlook.ranking[0],
    )
