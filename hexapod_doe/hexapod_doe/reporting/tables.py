# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The tables of the report: what one is, and those of predictions, effects, aliases and runs."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from hexapod_doe.designs.factor import shown
from hexapod_doe.fitting.alias_matrix import short_alias, with_partial_aliases
from hexapod_doe.records.results import Analysis, Prediction
from hexapod_doe.reporting.formats import MISSING, aligned, chance, interval
from hexapod_doe.reporting.standing import Standing, standings
from hexapod_doe.reporting.words import factor_text, words
from hexapod_doe.sheets.write import write_csv

MAX_ROWS = 512
"""Sets listed on the page; the CSV has all."""
MAX_NAMES = 8
"""Terms of one sum that the page lists."""


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
        write_csv(self.data, folder / f'{self.name}.csv')


def predictions(analysis: Analysis) -> Table:
    """Tabulate all sets, best first."""
    every, ranks = standings(analysis), analysis.rank_uncertainty
    ranked = every[:MAX_ROWS]
    finals = {p.label: p for p in analysis.predictions}
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
        f'All {len(every)} sets'
        if every == ranked
        else f'The {MAX_ROWS} best of {len(every)} sets',
        f'Intervals and ranks hold with {100 * analysis.level:g} %. Safe: the prediction is the '
        'same whichever name a confounded sum is given.',
        cells,
        pd.DataFrame([_prediction_record(analysis, s, finals) for s in every]),
    )


def aliases(analysis: Analysis) -> Table | None:
    """Tabulate the sums that the cases cannot take apart."""
    mixed = {term: text for term, text in analysis.design.aliases.items() if ' ' in text}
    if not mixed:
        return None
    return Table(
        'aliases',
        'What the cases cannot tell apart',
        f'{analysis.design.defining_relation}. Each row is one contrast: the data see the sum, in '
        'which a number is the share that the contrast holds of a term.',
        {
            'named after': list(mixed),
            'sum': [short_alias(text, MAX_NAMES) for text in mixed.values()],
            'in the final model': [
                'yes' if term in analysis.final.terms else '' for term in mixed
            ],
        },
        pd.DataFrame({'term': mixed.keys(), 'alias': mixed.values()}),
    )


def alias_matrix(analysis: Analysis) -> Table | None:
    """Tabulate what each term of the model holds of others in part."""
    partial = {} if analysis.attribution is None else analysis.attribution.partial
    if not partial:
        return None
    rows = [
        (term, other, weight)
        for term, others in partial.items()
        for other, weight in others.items()
    ]
    return Table(
        'alias_matrix',
        'What the terms hold of others',
        'The columns of this design are correlated in part: each coefficient is its own effect '
        'plus these shares of effects that the model leaves out. The CSV has the whole matrix.',
        {
            'term': list(partial),
            'holds': [
                short_alias(with_partial_aliases(term, others), MAX_NAMES)
                for term, others in partial.items()
            ],
        },
        pd.DataFrame(rows, columns=['term', 'omitted', 'weight']),
    )


def main_effects(analysis: Analysis) -> Table:
    """Tabulate the mean response with and without each factor."""
    design, found = analysis.design, analysis.main_effects
    named = words(design)
    return Table(
        'main_effect_means',
        'Main effects',
        f'Fitted means over all combinations of the other {named.noun}s, by the first model. Raw '
        'means are of the runs that there are, none left out: where cases have unequal runs, '
        f'other {named.noun}s have a part in their difference.',
        {
            named.noun: [factor_text(design, e.factor) for e in found],
            named.low: aligned([e.fitted_without for e in found], 4),
            named.high: aligned([e.fitted_with for e in found], 4),
            'effect': aligned([e.effect for e in found], 4, sign=True),
            'standard error': aligned([e.se_effect for e in found], 3),
            f'raw mean {named.low}': aligned([e.mean_without for e in found], 4),
            f'raw mean {named.high}': aligned([e.mean_with for e in found], 4),
        },
        pd.DataFrame([vars(effect) for effect in found]),
    )


def factors(analysis: Analysis) -> Table | None:
    """Tabulate the factors with their levels, where they are not sensors alone."""
    design = analysis.design
    if design.sensors or not design.named:
        return None
    cells = {
        'letter': [factor.letter for factor in design.named],
        'factor': [factor.name for factor in design.named],
        'low': [shown(factor.low) for factor in design.named],
        'high': [shown(factor.high) for factor in design.named],
        'key': [factor.key for factor in design.named],
    }
    return Table(
        'factors',
        f'The {len(design.named)} factors',
        'A set is named by the letters of its factors at the high level; the others are at the '
        'low one.',
        cells,
        pd.DataFrame([factor.entry() for factor in design.named]),
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


def _prediction_record(
    analysis: Analysis, standing: Standing, finals: Mapping[str, Prediction]
) -> dict[str, object]:
    ranks, label = analysis.rank_uncertainty, standing.label
    final = finals[label]
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
