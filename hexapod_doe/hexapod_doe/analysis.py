# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The whole analysis of one table: models, predictions, choice, and what is uncertain in them."""

import dataclasses
from collections.abc import Sequence

from hexapod_doe.attribution import alias_safe
from hexapod_doe.options import Options
from hexapod_doe.pipeline import Pipeline, run
from hexapod_doe.prediction import predict_all
from hexapod_doe.regression import curvature
from hexapod_doe.results import Analysis, DesignSummary
from hexapod_doe.steps import aliases_of, main_effects, removals, step_record
from hexapod_doe.table import RunTable, describe_words, missing_cases


def analyse(tables: Sequence[RunTable], options: Options) -> Analysis:
    """Analyse a table; further tables are other designs to compare, with the same options."""
    first, *others = tables
    compared = tuple(analyse([other], options) for other in others)
    return dataclasses.replace(_analyse(first, options), compared=compared)


def _analyse(table: RunTable, options: Options) -> Analysis:
    options = options.as_article() if options.article else options
    state = run(table, options)
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
        caveats=(*table.caveats, *_design_caveats(design), *state.caveats),
        main_effects=main_effects(table, _error(state)),
        steps=tuple(step_record(step, aliases) for step in state.steps),
        elimination=removals(state.dropped, aliases),
        transform=state.transform,
        lenth=state.lenth,
        curvature=curvature(table.levels, table.values),
        level=options.level,
        predictions=predictions,
        ranking=ranking,
        choice=ranking[0],
        choice_rule='highest prediction of the final model',
    )


def summarise(table: RunTable, aliases: dict[str, str]) -> DesignSummary:
    """Describe the design that the rows of a table show."""
    missing, expected = missing_cases(table.levels)
    relation, resolution = describe_words(table.levels)
    centre = table.levels.eq(0).all(axis=1)
    runs = table.rows[~centre].groupby('case').size()
    generated = len(table.factors) - expected.bit_length() + 1
    size = f'2^({len(table.factors)}-{generated})' if generated else f'2^{len(table.factors)}'
    return DesignSummary(
        name=table.design or size,
        factors=table.factors,
        factor_names=table.factor_names,
        defining_relation=relation,
        resolution=resolution,
        cases=len(runs),
        expected_cases=expected,
        missing_cases=missing,
        runs=len(table.rows),
        replicates=(int(runs.min()), int(runs.max())),
        centre_points=int(centre.sum()),
        aliases=aliases,
    )


def _error(state: Pipeline) -> float | None:
    """Return the residual standard deviation of the first model that has one, on all rows."""
    rows = len(state.table.rows)
    for step in state.steps:
        if step.fit.s is not None and step.fit.n == rows and not step.transformed:
            return step.fit.s
    return None


def _design_caveats(design: DesignSummary) -> list[str]:
    caveats = []
    if design.missing_cases:
        caveats.append(
            f'{len(design.missing_cases)} of {design.expected_cases} cases are missing '
            f'({", ".join(design.missing_cases[:8])}): the columns are no longer orthogonal, '
            'standard errors differ and some terms may be left out.'
        )
    low, high = design.replicates
    if low != high:
        caveats.append(f'Cases have between {low} and {high} runs: the fit weighs each run alike.')
    return caveats
