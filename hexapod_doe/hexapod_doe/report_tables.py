# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The tables of the report on the model: its history, its terms, its predictions, the runs."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from hexapod_doe.formats import MISSING, aligned, chance, interval, number, probability, signed
from hexapod_doe.results import Analysis, Step
from hexapod_doe.standing import Standing, standings
from hexapod_doe.terms import CONSTANT


@dataclass(frozen=True)
class Table:
    """A table twice: as text for the page, and at full precision for its CSV."""

    name: str
    title: str
    caption: str
    cells: Mapping[str, Sequence[str]]
    """Heading -> the column's texts."""
    data: pd.DataFrame

    @property
    def rows(self) -> list[tuple[str, ...]]:
        """The texts, row by row."""
        return list(zip(*self.cells.values(), strict=True))

    def save(self, folder: Path) -> None:
        """Write the CSV."""
        self.data.to_csv(folder / f'{self.name}.csv', index=False, lineterminator='\n')


def predictions(analysis: Analysis) -> Table:
    """Tabulate all sets, best first."""
    ranked, ranks = standings(analysis), analysis.rank_uncertainty
    cells = {
        'rank': [f'{s.rank}' for s in ranked],
        'set': [s.label for s in ranked],
        'predicted': aligned([s.value for s in ranked], 4),
        'interval of the mean': [interval(s.ci) for s in ranked],
        'of one run': [interval(s.pi) for s in ranked],
        'trained': ['yes' if s.tested else '' for s in ranked],
        'safe': ['yes' if s.alias_safe else '' for s in ranked],
    }
    if ranks is not None:
        cells |= {
            'P(best)': [chance(ranks.p_best.get(s.label)) for s in ranked],
            'P(top 3)': [chance(ranks.p_top3.get(s.label)) for s in ranked],
            'ranks': [_ranks(ranks.rank_interval.get(s.label)) for s in ranked],
        }
    return Table(
        'predictions',
        f'All {len(ranked)} sets',
        f'Intervals and ranks hold with {100 * analysis.level:g} %. Safe: the prediction is the '
        'same whichever name a confounded sum is given.',
        cells,
        pd.DataFrame([_prediction_record(analysis, s) for s in ranked]),
    )


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
        f'coefficient. A sum is all that the cases can see of its terms{scale}.',
        {
            'term': ['constant' if name == CONSTANT else name for name in names],
            'effect': aligned(columns['effects'], 4, sign=True),
            'coefficient': aligned(columns['coef'], 5, sign=True),
            'standard error': [number(value) for value in columns['se']],
            't': aligned(columns['t'], 4, sign=True),
            'p': [probability(value) for value in columns['p']],
        },
        pd.DataFrame({'term': step.terms, 'alias': names, **columns}),
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
            'term': [removal.alias for removal in dropped],
            'p': [probability(removal.p) for removal in dropped],
            's afterwards': aligned([removal.s for removal in dropped], 4),
            'R² afterwards': [number(removal.r2) for removal in dropped],
            'adjusted': [number(removal.r2_adj) for removal in dropped],
        },
        pd.DataFrame([vars(removal) for removal in dropped]),
    )


def aliases(analysis: Analysis) -> Table | None:
    """Tabulate the sums that the cases cannot take apart."""
    mixed = {term: text for term, text in analysis.design.aliases.items() if ' ' in text}
    if not mixed:
        return None
    return Table(
        'aliases',
        'What the cases cannot tell apart',
        f'{analysis.design.defining_relation}. Each row is one contrast: the data see the sum.',
        {
            'named after': list(mixed),
            'sum': list(mixed.values()),
            'in the final model': [
                'yes' if term in analysis.final.terms else '' for term in mixed
            ],
        },
        pd.DataFrame({'term': mixed.keys(), 'alias': mixed.values()}),
    )


def main_effects(analysis: Analysis) -> Table:
    """Tabulate the mean response with and without each factor."""
    names, found = analysis.design.factor_names, analysis.main_effects
    return Table(
        'main_effect_means',
        'Main effects',
        'Means over all runs, none left out.',
        {
            'sensor': [f'{e.factor} {names.get(e.factor, "")}'.strip() for e in found],
            'without': aligned([e.mean_without for e in found], 4),
            'with': aligned([e.mean_with for e in found], 4),
            'effect': aligned([e.effect for e in found], 4, sign=True),
            'standard error': aligned([e.se_effect for e in found], 3),
        },
        pd.DataFrame([vars(effect) for effect in found]),
    )


def runs(analysis: Analysis) -> Table:
    """Tabulate every run."""
    table = analysis.table
    return Table(
        'runs',
        f'All {len(table)} runs',
        'In the order of the plan.',
        {
            'run': list(table['run_id'].astype(str)),
            'case': list(table['case'].astype(str)),
            'replicate': list(table['replicate'].astype(str)),
            'set': list(table['label']),
            analysis.response.replace('_', ' '): aligned(table['response'].tolist(), 4),
            'fitted': ['yes' if kept else '' for kept in table['kept']],
        },
        table,
    )


def _ranks(bounds: tuple[int, int] | None) -> str:
    if bounds is None:
        return MISSING
    low, high = bounds
    return f'{low}' if low == high else f'{low} to {high}'


def _prediction_record(analysis: Analysis, standing: Standing) -> dict[str, object]:
    ranks, label = analysis.rank_uncertainty, standing.label
    final = next(p for p in analysis.predictions if p.label == label)
    extra = {} if ranks is None else {
        'p_best': ranks.p_best.get(label), 'p_top3': ranks.p_top3.get(label)
    }  # fmt: skip
    return {
        'rank': standing.rank,
        'label': label,
        **standing.levels,
        'value': standing.value,
        'ci_low': standing.ci[0],
        'ci_high': standing.ci[1],
        'pi_low': standing.pi[0],
        'pi_high': standing.pi[1],
        'tested': standing.tested,
        'alias_safe': standing.alias_safe,
        'final_model_rank': final.rank,
        'final_model_fit': final.fit,
        'final_model_ci_low': final.ci[0],
        'final_model_ci_high': final.ci[1],
        **extra,
    }


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


def checks(analysis: Analysis) -> Table | None:
    """Tabulate the tests of the model as a whole: lack of fit, curvature, Lenth's margins."""
    rows: list[tuple[str, str, str, float | None]] = []
    lack, curvature, lenth = analysis.final.lack_of_fit, analysis.curvature, analysis.lenth
    if lack is not None:
        test = f'F({lack.df_lack_of_fit}, {lack.df_pure_error}) = {number(lack.f)}'
        rows.append(('lack of fit', 'cases against the spread of their runs', test, lack.p))
    if curvature is not None:
        test = f'difference {signed(curvature.difference)}'
        rows.append(('curvature', 'centre points against the other runs', test, curvature.p))
    if lenth is not None:
        test = f'ME {number(lenth.margin)}, SME {number(lenth.simultaneous_margin)}'
        rows.append(('Lenth’s margins', f'pseudo standard error {number(lenth.pse)}', test, None))
    if not rows:
        return None
    return Table(
        'checks',
        'Tests of the model',
        'A small p says that the model misses something that the runs show.',
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
