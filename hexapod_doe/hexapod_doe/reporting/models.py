# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The tables of the report on the fitted models: their history, terms, tests and transform."""

import pandas as pd

from hexapod_doe.designs.terms import CONSTANT
from hexapod_doe.fitting.alias_matrix import short_alias
from hexapod_doe.records.results import Analysis, Step
from hexapod_doe.reporting.formats import MISSING, aligned, interval, number, probability, signed
from hexapod_doe.reporting.tables import Table


def steps(analysis: Analysis) -> Table:
    """Tabulate the models from first to last: the improvement table."""
    found = analysis.steps
    return Table(
        'steps',
        'From the first to the final model',
        'R² of the fitted runs, adjusted for the number of terms, for runs left out one at a time '
        '(predicted) and for whole cases left out; s is on the scale of the step.',
        {
            'model': [f'{step.name}: {step.description}' for step in found],
            'runs': [f'{step.n}' for step in found],
            'terms': [f'{len(step.terms)}' for step in found],
            'R²': [number(step.r2) for step in found],
            'adjusted': [number(step.r2_adj) for step in found],
            'predicted': [number(step.r2_pred) for step in found],
            'by case': [number(step.r2_pred_cases) for step in found],
            's': [number(step.s) for step in found],
            'lack of fit p': [
                probability(step.lack_of_fit.p if step.lack_of_fit else None) for step in found
            ],
        },
        pd.DataFrame([_step_record(step) for step in found]),
    )


def model_terms(analysis: Analysis) -> Table:
    """Tabulate the terms of the final model, each with its alias string."""
    step = analysis.final
    columns = {
        name: [getattr(step, name).get(term) for term in step.terms]
        for name in ('effects', 'coef', 'se', 't', 'p')
    }
    names = [step.aliases.get(term, term) for term in step.terms]
    scale = '; the scale is that of the transformed response' if step.scale != 'response' else ''
    return Table(
        'model_terms',
        'Terms of the final model',
        'An effect is the mean response with the term at +1 minus that at −1, twice the '
        'coefficient. A sum is all that the cases can see of its terms. VIF: by how much other '
        f'terms swell the variance of the estimate{scale}.',
        {
            'term': ['constant' if name == CONSTANT else short_alias(name, 8) for name in names],
            'effect': aligned(columns['effects'], 4, sign=True),
            'coefficient': aligned(columns['coef'], 5, sign=True),
            'standard error': [number(value) for value in columns['se']],
            't': aligned(columns['t'], 4, sign=True),
            'p': [probability(value) for value in columns['p']],
            'VIF': [number(step.vif.get(term)) for term in step.terms],
        },
        pd.DataFrame(
            {
                'term': step.terms,
                'alias': names,
                **columns,
                'vif': [step.vif.get(term) for term in step.terms],
            }
        ),
    )


def anova(analysis: Analysis) -> Table | None:
    """Tabulate the analysis of variance of the final model."""
    found = analysis.final.anova
    if not found:
        return None
    return Table(
        'anova',
        'Analysis of variance of the final model',
        'Adjusted sums of squares: what the error grows by without the source, all others kept. '
        'F against the error; of the lack of fit against the pure error, the spread within cases.',
        {
            'source': [row.source for row in found],
            'df': [f'{row.df}' for row in found],
            'Adj SS': [number(row.ss) for row in found],
            'Adj MS': [number(row.ms) for row in found],
            'F': [number(row.f) for row in found],
            'p': [probability(row.p) for row in found],
        },
        pd.DataFrame([vars(row) for row in found]),
    )


def elimination(analysis: Analysis) -> Table | None:
    """Tabulate the backward elimination, one row per term that was dropped."""
    dropped = analysis.elimination
    if not dropped:
        return None
    return Table(
        'elimination',
        'Terms that were dropped, in order',
        'At each step the term with the largest p goes, if no remaining term contains it.',
        {
            'step': [f'{removal.step}' for removal in dropped],
            'term': [short_alias(removal.alias, 8) for removal in dropped],
            'p': [probability(removal.p) for removal in dropped],
            's afterwards': aligned([removal.s for removal in dropped], 4),
            'R² afterwards': [number(removal.r2) for removal in dropped],
            'adjusted': [number(removal.r2_adj) for removal in dropped],
        },
        pd.DataFrame([vars(removal) for removal in dropped]),
    )


def checks(analysis: Analysis) -> Table | None:
    """Tabulate the tests of the model as a whole: lack of fit, curvature, Lenth's margins."""
    rows: list[tuple[str, str, str, float | None]] = []
    lack, curvature, lenth = analysis.final.lack_of_fit, analysis.curvature, analysis.lenth
    blocks = analysis.final.blocks
    if lack is not None:
        test = f'F({lack.df_lack_of_fit}, {lack.df_pure_error}) = {number(lack.f)}'
        rows.append(('lack of fit', 'cases against the spread of their runs', test, lack.p))
    if curvature is not None:
        test = f'difference {signed(curvature.difference)}'
        rows.append(('curvature', 'centre points against the other runs', test, curvature.p))
    if blocks is not None and blocks.f is not None:
        test = f'F({blocks.df}, {analysis.final.df_error}) = {number(blocks.f)}'
        what = f'differences by {analysis.design.block_column}, taken out of the model'
        rows.append(('blocks', what, test, blocks.p))
    if lenth is not None:
        test = f'ME {number(lenth.margin)}, SME {number(lenth.simultaneous_margin)}'
        rows.append(('Lenth’s margins', f'pseudo standard error {number(lenth.pse)}', test, None))
    if not rows:
        return None
    return Table(
        'checks',
        'Tests of the model',
        'A small p says that the model misses something that the runs show; of blocks, that they '
        'differ.',
        {
            'test': [name for name, *_ in rows],
            'of': [what for _, what, *_ in rows],
            'value': [test for _, _, test, _ in rows],
            'p': [probability(p) for *_, p in rows],
        },
        pd.DataFrame(rows, columns=['test', 'of', 'value', 'p']),
    )


def transform(analysis: Analysis) -> Table | None:
    """Tabulate the transform of the response, and how λ depends on the shift before it."""
    found = analysis.transform
    if found is None:
        return None
    rows = [(None, found.shift, found.lambda_hat), *(
        (s.margin, s.shift, s.lambda_hat) for s in found.sensitivity
    )]  # fmt: skip
    used = f'{found.kind}, λ = {found.lambda_:g}'
    bounds = interval(found.lambda_ci) if found.lambda_ci else MISSING
    return Table(
        'transform',
        f'The response was transformed: {used}',
        f'Shift: {found.shift_rule}. 95 % interval of λ given the model: {bounds}. Another shift '
        'would give another λ, which has therefore no meaning of its own.',
        {
            'margin, share of range': ['as used', *(number(margin) for margin, *_ in rows[1:])],
            'shift': aligned([shift for _, shift, _ in rows], 5),
            'best λ': aligned([best for *_, best in rows]),
        },
        pd.DataFrame(rows, columns=['margin', 'shift', 'lambda_hat']),
    )


def _step_record(step: Step) -> dict[str, object]:
    names = ('name', 'scale', 'n', 'r2', 'r2_adj', 'r2_pred', 'r2_pred_cases', 'press', 's')
    lack = step.lack_of_fit
    return {
        **{name: getattr(step, name) for name in names},
        'terms': len(step.terms),
        'df_error': step.df_error,
        'sse': step.sse,
        'lack_of_fit_p': lack.p if lack else None,
    }
