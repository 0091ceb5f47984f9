# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The report's sentences: what was found, how sure it is, and what to know before believing it.

Every sentence is derived from the numbers of the analysis.
"""

from dataclasses import dataclass

from hexapod_doe.designs.planner import FULL_TRAINING
from hexapod_doe.fitting.alias_matrix import short_alias
from hexapod_doe.records.findings import Purchase
from hexapod_doe.records.results import Analysis
from hexapod_doe.reporting.formats import (
    MISSING,
    capitalised,
    chance,
    count,
    interval,
    listing,
    number,
    percent,
    signed,
)
from hexapod_doe.reporting.standing import Standing, all_alike, deciding_parts, standings
from hexapod_doe.reporting.words import set_text, words

TOUR_EPISODES = 100
"""With fewer episodes than this an agent has hardly begun to learn."""
FEW_REPLICATES = 3
"""With fewer runs per case than this, one failed training can move a conclusion."""


@dataclass(frozen=True)
class Fact:
    """One number at the head of the report."""

    label: str
    value: str
    note: str


def episodes(analysis: Analysis) -> int | None:
    """Return the episodes of the longest training; None where no learning curves are known."""
    if analysis.curves.empty:
        return None
    return int(analysis.curves.groupby('run_id')['episode'].nunique().max())


def is_tour(analysis: Analysis) -> bool:
    """Whether the trainings are too short to have learned."""
    length = episodes(analysis)
    return length is not None and length < TOUR_EPISODES


def caution(analysis: Analysis) -> str:
    """Return the first line of a report on little data; empty where there is enough."""
    length, replicates = episodes(analysis), analysis.design.replicates[1]
    single = replicates == 1
    if length is not None and is_tour(analysis):
        tail = ', and with one run per case chance passes for an effect' if single else ''
        return (
            f'{capitalised(count(length, "episode"))} {"is" if length == 1 else "are"} a tour, '
            f'not a conclusion: the agents have hardly begun to learn{tail}. This page shows '
            f'what the method says, not {words(analysis.design).question}.'
        )
    if length is not None and length < FULL_TRAINING / 2:
        return (
            f'{length} episodes are an interim result: a whole training has {FULL_TRAINING}, and '
            'the order of the sets may still change.'
        )
    if single:
        return (
            'One run per case is a sketch, not a conclusion: how much runs of one case differ by '
            'chance is unknown.'
        )
    if replicates < FEW_REPLICATES:
        return (
            f'{capitalised(count(replicates, "run"))} per case are few: a failed training weighs.'
        )
    return ''


def headline(analysis: Analysis) -> str:
    """Return the answer in one sentence."""
    name = name_of(analysis, chosen_standing(analysis))
    if all_alike(standings(analysis)):
        return f'These runs show no difference between the {words(analysis.design).sets}'
    if analysis.final.r2_pred is None:
        return f'{capitalised(name)} comes first; how surely, these runs cannot say'
    if analysis.final.r2_pred <= 0:
        return f'No {words(analysis.design).set} stands out yet; {name} comes first'
    return f'Choose {name}'


def chosen_standing(analysis: Analysis) -> Standing:
    """Return where the chosen set stands."""
    return next(s for s in standings(analysis) if s.label == analysis.choice)


def name_of(analysis: Analysis, standing: Standing) -> str:
    """Return the letters of a set of sensors, the levels of other factors."""
    design = analysis.design
    if design.named and not design.sensors:
        return set_text(design, standing.levels)
    return standing.label if standing.size else words(design).none


def description(analysis: Analysis, standing: Standing) -> str:
    """Return what a set holds: the names of its sensors, or its letters in tables and figures."""
    design = analysis.design
    if design.named and not design.sensors:
        return f'{standing.label} in the tables and figures'
    if not design.sensors:
        return set_text(design, standing.levels) or words(design).none
    return set_text(design, standing.levels) or 'only what is always observed'


def facts(analysis: Analysis) -> list[Fact]:
    """Return the numbers that stand at the head of the report."""
    best = chosen_standing(analysis)
    found = [
        Fact(
            f'predicted {analysis.response.replace("_", " ")}',
            number(best.value),
            f'{_level(analysis)} interval {interval(best.ci)}',
        ),
        _against_all(analysis, best),
        _certainty(analysis, best),
    ]
    if analysis.purchase is not None:
        found.append(_cheapest(analysis.purchase))
    return found


def _level(analysis: Analysis) -> str:
    return f'{100 * analysis.level:g} %'


def _against_all(analysis: Analysis, best: Standing) -> Fact:
    """Return what the choice earns more than the whole set, as a number where it can be told."""
    whole = words(analysis.design).whole
    label = f'against {whole}'
    every = max(standings(analysis), key=lambda standing: standing.size)
    if every.label == best.label:
        return Fact(label, 'the same', f'it is {whole}')
    gain = analysis.against_all
    if gain is None or None in gain.ci:
        note = f'predicted {signed(best.value - every.value)}; how surely, these runs cannot say'
        return Fact(label, MISSING, note)
    bounds = f'{_level(analysis)} interval {interval(gain.ci)}'
    low, high = gain.ci
    if low is not None and high is not None and low <= 0 <= high:
        return Fact(label, 'no difference told', f'{signed(gain.fit)}, {bounds}')
    return Fact(label, signed(gain.fit), f'{bounds}; all: {number(every.value)}')


def _cheapest(purchase: Purchase) -> Fact:
    """Return the cheapest set that is not worse, where one is that with the confidence asked."""
    label = 'cheapest set not worse'
    bought = next(s for s in purchase.sets if s.label == purchase.cheapest)
    if bought.p_not_worse < purchase.confidence:
        note = (
            f'none with {percent(purchase.confidence)}; {bought.label} comes nearest, '
            f'{chance(bought.p_not_worse)}'
        )
        return Fact(label, MISSING, note)
    price = f'{number(bought.cost)} {purchase.currency}, {chance(bought.p_not_worse)}'
    return Fact(label, bought.label, price)


def sureness(analysis: Analysis) -> list[str]:
    """Return sentences on how far the answer can be trusted."""
    best = chosen_standing(analysis)
    sentences = [_data(analysis), _model(analysis)]
    if not best.tested and not all_alike(standings(analysis)):
        sentences.append(
            f'{best.label} was not trained in this campaign: its reward is a prediction until '
            'runs confirm it.'
        )
    if not best.alias_safe:
        sentences.append(_alias_warning(analysis))
    if analysis.rank_uncertainty is not None and not all_alike(standings(analysis)):
        sentences.append(_rank(analysis))
    if analysis.two_part is not None and analysis.two_part.failures:
        sentences.append(_failures(analysis))
    return sentences


def settings(analysis: Analysis) -> str:
    """Return the options that were set, for the foot of the page."""
    plain_types = (str, int, float)  # bool is an int
    return ', '.join(
        f'{name.replace("_", " ")} {str(value).lower()}'
        for name, value in analysis.options.items()
        if isinstance(value, plain_types)
    )


def _certainty(analysis: Analysis, best: Standing) -> Fact:
    ranks = analysis.rank_uncertainty
    if ranks is not None and not all_alike(standings(analysis)):
        first = ranks.p_best.get(best.label)
        top = ranks.p_top3.get(best.label)
        note = f'in the top 3: {chance(top)}; expected loss {number(analysis.expected_loss)}'
        return Fact('chance to be the best set', chance(first), note)
    rivals = sum(
        best.ci[0] is not None and p.ci[1] is not None and p.ci[1] >= best.ci[0]
        for p in standings(analysis)
        if p.label != best.label
    )
    text = f'{rivals}' if best.ci[0] is not None else MISSING
    note = f'of {len(analysis.predictions)}, by their intervals'
    return Fact('sets not told from it', text, note)


def _data(analysis: Analysis) -> str:
    design = analysis.design
    low, high = design.replicates
    runs = f'{low}' if low == high else f'{low} to {high}'
    length = episodes(analysis)
    trained = f', {count(length, "episode")} each' if length is not None else ''
    others = ' and '.join(
        f'the {other.design.name} ({other.design.runs} runs)' for other in analysis.compared
    )
    compared = f'; compared with {others}' if others else ''
    return (
        f'Data: {design.runs} trainings, {design.cases} cases × {runs}{trained} '
        f'({design.name}{compared}).'
    )


def _model(analysis: Analysis) -> str:
    final = analysis.final
    terms = f'The final model has {count(len(final.terms), "term")}'
    if final.r2 is None or final.df_error == 0:
        return f'{terms} and no error left to judge it by.'
    text = f'{terms} and explains {percent(final.r2)} of the variance of the fitted runs'
    if final.r2_pred is None:
        return f'{text}; how it predicts new runs cannot be computed.'
    if final.r2_pred <= 0:
        return f'{text}, but predicts runs left out of the fit worse than their mean would.'
    cases = ''
    if final.r2_pred_cases is not None:
        cases = f', and {percent(final.r2_pred_cases)} for whole cases left out'
    return f'{text}; for runs left out of the fit it predicts {percent(final.r2_pred)}{cases}.'


def _alias_warning(analysis: Analysis) -> str:
    named = (
        analysis.final.terms
        if analysis.attribution is None
        else (*analysis.attribution.ambiguous, *analysis.attribution.partial)
    )
    texts = (analysis.design.aliases.get(term, term) for term in named)
    mixed = [short_alias(text) for text in texts if ' ' in text]
    text = (
        f'{analysis.choice} depends on which name a confounded sum is given '
        f'({listing(mixed, 3)}): more cases can separate them (plan augment).'
    )
    if analysis.attribution is not None and len(analysis.attribution.winners) > 1:
        winners = sorted(analysis.attribution.winners.items(), key=lambda item: -item[1])
        total = sum(analysis.attribution.winners.values())
        shares = [f'{label} in {ways} of {total}' for label, ways in winners]
        text += f' Equally good namings choose {listing(shares, 4)}.'
    return text


def _rank(analysis: Analysis) -> str:
    ranks = analysis.rank_uncertainty
    assert ranks is not None  # the caller has looked
    group = next((g for g in ranks.groups if analysis.choice in g), (analysis.choice,))
    others = [label for label in group if label != analysis.choice]
    if not others:
        return f'No other set is within reach of {analysis.choice} in the same data.'
    return f'Cannot be told from it with these data: {listing(others, 6)}.'


def _failures(analysis: Analysis) -> str:
    parts = analysis.two_part
    assert parts is not None  # the caller has looked
    if deciding_parts(analysis) is not None:
        first = analysis.ranking[0]
        same = 'also puts it first' if first == analysis.choice else f'puts {first} first'
        return f'The final model, which takes failed runs for noise, {same}.'
    same = ' as well' if parts.choice == analysis.choice else ''
    return f'Weighed by the chance of a failed training, {parts.choice} comes first{same}.'
