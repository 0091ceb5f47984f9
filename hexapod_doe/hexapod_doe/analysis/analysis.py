# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The whole analysis of one table: models, predictions, choice, and what is uncertain in them."""

import dataclasses
from collections.abc import Mapping, Sequence

import numpy as np

from hexapod_doe.analysis.describe import design_caveats, model_caveats, scoring_caveats, summarise
from hexapod_doe.bags.run_identity import differences
from hexapod_doe.choosing.attribution import alias_safe
from hexapod_doe.choosing.choice import Failures, expected_loss, model_failures
from hexapod_doe.choosing.conclusions import conclude
from hexapod_doe.choosing.confirm import confirm
from hexapod_doe.choosing.estimate import estimates
from hexapod_doe.choosing.failure import two_groups
from hexapod_doe.choosing.outlook import final_outlook
from hexapod_doe.choosing.prediction import predict_all
from hexapod_doe.errors import TableError
from hexapod_doe.fitting.curvature import curvature
from hexapod_doe.fitting.estimands import estimand, pseudo_values
from hexapod_doe.modelling.pipeline import Pipeline, run
from hexapod_doe.modelling.steps import aliases_of, main_effects, removals, step_record
from hexapod_doe.records.options import Options
from hexapod_doe.records.results import Analysis
from hexapod_doe.tables.caveats import (
    disagreement_caveat,
    dispersion_caveat,
    failure_caveats,
    few_runs_caveat,
    unseen_caveat,
)
from hexapod_doe.tables.table import RESPONSE, RunTable


def analyse(
    tables: Sequence[RunTable],
    options: Options,
    confirmation_runs: Mapping[str, Sequence[float]] | None = None,
) -> Analysis:
    """Analyse a table; further tables are other designs to compare, with the same options.

    Args:
        tables: One table for each design.
        options: The settings.
        confirmation_runs: Responses of confirmation runs by label, to be judged.

    Raises:
        TableError: A table does not allow what the options ask for, or has other factors.
        AliasedTermsError: The named terms cannot be told apart.
        AnalysisError: An option cannot be read.
    """
    options = options.as_article() if options.article else options
    first, *others = tables
    for other in others:
        if (other.factors, other.named) != (first.factors, first.named):
            raise TableError(
                f'{other.title}: factors {_factors(other)}, expected those of {first.title}, '
                f'{_factors(first)}; analyse one of them at a time'
            )
    compared = tuple(_analyse(other, options, {}) for other in others)
    found = _analyse(first, options, confirmation_runs or {})
    caveats = (*found.caveats, *_comparison_caveats(first, others))
    return dataclasses.replace(found, compared=compared, caveats=caveats)


def _factors(table: RunTable) -> str:
    return ', '.join(factor.change for factor in table.named) or ','.join(table.factors)


def _comparison_caveats(first: RunTable, others: Sequence[RunTable]) -> list[str]:
    """Return what a reader must know of designs whose runs differ in more than their factors."""
    found = {other.title: differences(other.settings, first.settings) for other in others}
    return [
        f'The runs of {title} are not like those of {first.title} ({odd}): each design is '
        'analysed by itself, and they differ by that, too.'
        for title, odd in found.items()
        if odd
    ]


def _analyse(
    table: RunTable, options: Options, confirmation_runs: Mapping[str, Sequence[float]]
) -> Analysis:
    rng = np.random.default_rng(options.seed)
    analysed = _with_estimand(table, options)
    state = run(analysed, options)
    base = _modelled(analysed, state, options)
    failures = model_failures(table, options, rng) if options.estimand == 'mean' else None
    outlook = final_outlook(state, rng)
    if failures is not None and not options.article:
        outlook = failures.outlook
    analysis = dataclasses.replace(
        base,
        table=base.table.assign(failed=False if failures is None else failures.failed),
        choice=outlook.ranking[0],
        choice_rule=outlook.choice_rule,
        expected_loss=expected_loss(outlook, options.seed),
        two_part=None if failures is None else failures.record,
        estimands=estimates(table, options.level),
        **conclude(table, outlook, options, rng),
        confirmation=confirm(outlook, options.confirmation, confirmation_runs),
    )
    noun = 'sensor' if base.design.sensors else 'factor'
    failed = _failure_caveats(table, options, failures, noun)
    spread = dispersion_caveat(outlook.dispersion, 'successes' if analysis.two_part else 'runs')
    mean = [e.predictions for e in analysis.estimands if e.name == 'mean']
    if analysis.two_part is not None and mean:
        failed += disagreement_caveat(analysis.two_part.expected, mean[0])
    caveats = (*base.caveats, *failed, *spread, *model_caveats(analysis))
    return dataclasses.replace(analysis, caveats=caveats)


def _failure_caveats(
    table: RunTable, options: Options, failures: Failures | None, noun: str
) -> list[str]:
    if failures is not None:
        runs = int(table.rows.groupby('case').size().max())
        return [*failure_caveats(failures.record, options.alpha, noun), *few_runs_caveat(runs)]
    threshold = options.failure_threshold
    if options.estimand != 'mean':
        return []
    if threshold is None:
        return unseen_caveat(two_groups(table.values, table.rows['case'].to_numpy()), table.values)
    below = int((table.values < threshold).sum())
    return [
        f'{below} of {len(table.rows)} runs are below the threshold {threshold:g}: too few of one '
        'kind for a model of failures.'
    ]


def _with_estimand(table: RunTable, options: Options) -> RunTable:
    if options.estimand == 'mean':
        return table
    if options.trim_worst:
        raise TableError(f'estimand {options.estimand!r} uses all runs: leave out --trim-worst')
    item = estimand(options.estimand)
    values = pseudo_values(item, table.values, table.rows['case'])
    text = (
        f'The response analysed is the {item.description} of each case ({item.name}), '
        'as jackknife pseudo-values of the runs.'
    )
    return dataclasses.replace(
        table,
        rows=table.rows.assign(**{RESPONSE: values}),
        response=f'{table.response} ({item.name})',
        caveats=(*table.caveats, text),
    )


def _modelled(table: RunTable, state: Pipeline, options: Options) -> Analysis:
    """Return the analysis as far as the fitted models go."""
    aliases = aliases_of(table, state.steps, state.dropped)
    final = state.steps[-1]
    predictions = predict_all(
        final.fit,
        table.factors,
        state.transform,
        options.level,
        set(table.rows['label']),
        alias_safe(table.levels, final.fit.terms),
    )
    design = summarise(table, aliases)
    ranking = tuple(p.label for p in sorted(predictions, key=lambda p: p.rank))
    return Analysis(
        title=table.title,
        source=table.source,
        response=table.response,
        options=dataclasses.asdict(options),
        design=design,
        table=table.rows.assign(kept=state.kept),
        curves=table.curves,
        caveats=(
            *table.caveats,
            *design_caveats(design),
            *scoring_caveats(design, table.response),
            *state.caveats,
        ),
        main_effects=main_effects(table, state.steps[0].fit),
        steps=tuple(step_record(step, aliases) for step in state.steps),
        elimination=removals(state.dropped, aliases),
        transform=state.transform,
        lenth=state.lenth,
        curvature=curvature(table.levels, table.values, table.all_blocks),
        level=options.level,
        predictions=predictions,
        ranking=ranking,
        choice=ranking[0],
        choice_rule='',
    )
