# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Figures of what each factor does: mean responses at its two levels."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hexapod_doe.designs.terms import CONSTANT, is_interaction, order
from hexapod_doe.fitting.alias_matrix import short_alias
from hexapod_doe.records.results import Analysis, DesignSummary, MainEffect
from hexapod_doe.reporting.figures.chart import Chart
from hexapod_doe.reporting.figures.parts import (
    canvas,
    design_label,
    designs,
    factor_label,
    grid,
    unit_label,
)
from hexapod_doe.reporting.figures.significance import sizes
from hexapod_doe.reporting.figures.style import INK, MARKERS, MUTED, SERIES, SURFACE
from hexapod_doe.reporting.formats import capitalised, number, signed
from hexapod_doe.reporting.words import Words, level_text, words

MAX_INTERACTIONS = 6
"""More panels than this are tables, not figures."""


def main_effects(analysis: Analysis) -> Chart:
    """Draw the fitted mean at both levels of each factor, for every design, with SE bars."""
    named = words(analysis.design)
    ordered = sorted(analysis.main_effects, key=lambda effect: -abs(effect.effect))
    factors = [effect.factor for effect in ordered]
    rows = [
        {'design': other.design.name, **_record(effect)}
        for other in designs(analysis)
        for effect in other.main_effects
    ]

    def draw() -> Figure:
        figure, axes = canvas(3.9)
        several = designs(analysis)
        for index, other in enumerate(several):
            shift = 0.1 * (index - (len(several) - 1) / 2)
            _draw_design(axes, other, factors, index, shift)
        axes.axhline(_mean(analysis), color=MUTED, linewidth=0.7, linestyle=(0, (2, 3)))
        names = [factor_label(analysis.design, f, 11) for f in factors]
        axes.set_xticks(range(len(factors)), names)
        axes.tick_params(axis='x', labelcolor=INK)
        axes.set_ylabel(unit_label(analysis))
        _legend(axes, len(several), named)
        return figure

    return Chart(
        'main_effects',
        _main_effects_title(analysis, ordered[0]),
        f'Each pair joins the fitted mean {named.at_low} (hollow) to that {named.at_high} '
        '(filled), over all combinations of the others; bars are one standard error of each. '
        f'{capitalised(named.noun)}s are ordered by the size of their effect; the dotted line is '
        'the mean of all runs. No run is left out here.',
        pd.DataFrame(rows),
        draw,
    )


def interactions(analysis: Analysis) -> Chart | None:
    """Draw the mean response at the four corners of the interactions that matter most."""
    terms = _interaction_terms(analysis)
    if not terms:
        return None
    data = pd.concat([_corners(analysis, term) for term in terms], ignore_index=True)
    aliases = analysis.design.aliases

    def draw() -> Figure:
        figure, panels = grid(len(terms), 3, 1.4, below=0.55, foot=0.3)
        for axes, term in zip(panels, terms, strict=True):
            _draw_interaction(axes, data[data['term'] == term], term, analysis.design)
            axes.set_title(short_alias(aliases.get(term, term)), loc='left')
        figure.supylabel(unit_label(analysis), x=0.01, fontsize=9, color=MUTED)
        return figure

    in_model = [term for term in analysis.final.terms if order(term) == 2 and is_interaction(term)]
    title = (
        f'{len(in_model)} interactions stay in the model'
        if len(in_model) > 1
        else f'The interaction {in_model[0]} stays in the model'
        if in_model
        else 'No interaction is significant; these are the largest'
    )
    return Chart(
        'interactions',
        title,
        f'{words(analysis.design).interaction} Each panel is named by all terms that it may stand '
        'for.',
        data,
        draw,
    )


def _record(effect: MainEffect) -> dict[str, float | str | None]:
    return {
        'factor': effect.factor,
        'fitted_without': effect.fitted_without,
        'se_fitted_without': effect.se_fitted_without,
        'fitted_with': effect.fitted_with,
        'se_fitted_with': effect.se_fitted_with,
        'effect': effect.effect,
        'se_effect': effect.se_effect,
        'raw_mean_without': effect.mean_without,
        'raw_mean_with': effect.mean_with,
    }


def _draw_design(
    axes: Axes, analysis: Analysis, factors: list[str], index: int, shift: float
) -> None:
    colour, marker = SERIES[index % len(SERIES)], MARKERS[index % len(MARKERS)]
    effects = {effect.factor: effect for effect in analysis.main_effects}
    for slot, factor in enumerate(factors):
        effect = effects[factor]
        x = np.array([slot - 0.17, slot + 0.17]) + shift
        if effect.fitted_without is None or effect.fitted_with is None:
            continue  # the cases cannot tell it from others
        y = [effect.fitted_without, effect.fitted_with]
        error = [effect.se_fitted_without or 0, effect.se_fitted_with or 0]
        axes.plot(x, y, color=colour, linewidth=1.2, zorder=2)
        axes.errorbar(x, y, error, color=colour, linestyle='none', linewidth=1.2, zorder=2)
        axes.plot(x[0], y[0], marker, color=colour, markerfacecolor=SURFACE, zorder=3)
        axes.plot(x[1], y[1], marker, color=colour, zorder=3)
    axes.plot([], [], marker + '-', color=colour, label=design_label(analysis.design))


def _legend(axes: Axes, series: int, named: Words) -> None:
    if series == 1:
        axes.lines[-2].set_label('_')  # one design needs no name: the page has it
        colour, marker = SERIES[0], MARKERS[0]
        for face, label in zip((SURFACE, colour), named.legend, strict=True):
            axes.plot([], [], marker, color=colour, markerfacecolor=face, label=label)
    axes.legend(loc='lower left', bbox_to_anchor=(0, 1), ncols=2, borderaxespad=0, handlelength=1)


def _mean(analysis: Analysis) -> float:
    return float(analysis.table['response'].mean())


def _main_effects_title(analysis: Analysis, largest: MainEffect) -> str:
    name = factor_label(analysis.design, largest.factor)
    error = '' if largest.se_effect is None else f' ± {number(largest.se_effect, 2)}'
    size = f'{signed(largest.effect)}{error}'
    found = sizes(analysis)
    if found is None or largest.factor in found.active:
        title = f'{name} moves the response most: {size}'
    else:
        noun = words(analysis.design).noun
        title = f'No {noun} stands out from noise; the largest effect is {name}, {size}'
    overlapping = sum(
        _bars_overlap(effect, other)
        for compared in analysis.compared
        for effect, other in zip(analysis.main_effects, compared.main_effects, strict=True)
    )
    total = len(analysis.compared) * len(analysis.main_effects)
    if not total:
        return title
    return f'{title}; the error bars of {overlapping} of {total} effects overlap'


def _bars_overlap(first: MainEffect, second: MainEffect) -> bool:
    reach = (first.se_effect or 0) + (second.se_effect or 0)
    return abs(first.effect - second.effect) <= reach


def _interaction_terms(analysis: Analysis) -> list[str]:
    """Return two-factor terms of the final model, else the largest of the first one.

    A term that only a transformed model holds has no means in the units of the response.
    """
    final, first = analysis.final, analysis.steps[0]
    plain = {term for step in analysis.steps if step.scale == 'response' for term in step.terms}
    pool = [term for term in final.terms if order(term) == 2 and term in plain]
    pool = [term for term in pool if is_interaction(term)]
    sizes = final.effects if pool else first.effects
    pool = pool or [term for term in first.terms if order(term) == 2 and is_interaction(term)]
    limit = MAX_INTERACTIONS if sizes is final.effects else 3
    return sorted(pool, key=lambda term: -abs(sizes[term]))[:limit]


def _corners(analysis: Analysis, term: str) -> pd.DataFrame:
    """Return the fitted means at the four corners of two factors, by the fullest last model."""
    first, second = term[0], term[1]
    usable = [step for step in analysis.steps if step.scale == 'response' and term in step.terms]
    step = max(reversed(usable), key=lambda step: len(step.terms))
    coef = {name: step.coef.get(name, 0.0) for name in (CONSTANT, first, second, term)}
    table = analysis.table[analysis.table['kept']]
    return pd.DataFrame(
        {
            'first': a,
            'second': b,
            'mean': coef[CONSTANT] + a * coef[first] + b * coef[second] + a * b * coef[term],
            'runs': int(((table[first] == a) & (table[second] == b)).sum()),
            'term': term,
        }
        for a in (-1, 1)
        for b in (-1, 1)
    )


def _draw_interaction(axes: Axes, corners: pd.DataFrame, term: str, design: DesignSummary) -> None:
    first, second = term[0], term[1]
    lines = {level: corners[corners['second'] == level].sort_values('first') for level in (-1, 1)}
    ends = {level: float(line['mean'].iloc[-1]) for level, line in lines.items()}
    for level, colour, face in ((-1, MUTED, SURFACE), (1, SERIES[0], SERIES[0])):
        line = lines[level]
        axes.plot(line['first'], line['mean'], 'o-', color=colour, markerfacecolor=face)
        axes.annotate(
            level_text(design, second, level),
            (float(line['first'].iloc[-1]), ends[level]),
            (5, 4 if ends[level] > ends[-level] else -4),  # apart where the lines meet
            textcoords='offset points',
            va='center',
            color=colour,
            fontsize=8.5,
        )
    axes.set_xticks([-1, 1], [level_text(design, first, level) for level in (-1, 1)])
    axes.set_xlim(-1.4, 2.1)
    axes.margins(y=0.12)
