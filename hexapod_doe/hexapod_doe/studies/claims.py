# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The article's claims, one by one, against a study: each by a rule that is stated with it."""

from collections.abc import Callable
from dataclasses import asdict, dataclass

import numpy as np
from scipy import stats

from hexapod_doe.choosing.outlook import final_outlook
from hexapod_doe.modelling.pipeline import Pipeline
from hexapod_doe.reporting.formats import interval, listing, number, percent, signed
from hexapod_doe.reporting.standing import standings
from hexapod_doe.studies.study_data import Effect, StudyCampaign, effects_of

AGREES, DIFFERS, OPEN = 'agrees', 'does not agree', 'cannot be told'
_FAILING = 0.2
"""Share of failed trainings that the article shows, two of ten."""
_ITS_BEST = 'ABCDE'


@dataclass(frozen=True)
class Claim:
    """One claim of the article, and what a campaign says of it."""

    claim: str
    theirs: str
    rule: str
    """When the campaign agrees."""
    ours: str
    verdict: str


def claims_of(campaign: StudyCampaign) -> list[dict[str, str]]:
    """Return what a campaign says of each claim that it can be asked about."""
    made: list[Callable[[StudyCampaign], Claim | None]] = [
        _matters_most, _all_are_beaten, _fractions_agree, _share_fails, _steps_help,
        _three_confirm, _its_best_wins,
    ]  # fmt: skip
    found = (each(campaign) for each in made)
    return [asdict(claim) for claim in found if claim is not None]


def _matters_most(campaign: StudyCampaign) -> Claim:
    told, verdicts = [], []
    for name, analysis in campaign.fractions.items():
        effects = {effect.factor: effect for effect in effects_of(analysis)}
        best, other = max(effects.values(), key=lambda each: each.effect), effects['C']
        shown = dict.fromkeys((best, other))
        told.append(f'{name}: ' + ', '.join(_told(each) for each in shown))
        apart = best is not other and best.low > other.high
        verdicts.append(AGREES if best is other else DIFFERS if apart else OPEN)
    return Claim(
        'C, the body orientation, matters most',
        'largest effect in both fractions',
        'C has the largest effect in each fraction; it does not agree where the interval of '
        'another sensor lies above that of C in one',
        '; '.join(told),
        DIFFERS if DIFFERS in verdicts else OPEN if OPEN in verdicts else AGREES,
    )


def _told(effect: Effect) -> str:
    return f'{effect.factor} {signed(effect.effect)} ({interval((effect.low, effect.high))})'


def _all_are_beaten(campaign: StudyCampaign) -> Claim:
    analysis = campaign.whole
    every = ''.join(analysis.design.factors)
    gain = analysis.against_all
    means = analysis.table.groupby('label')['response'].mean()
    above = int((means > means[every]).sum()) if every in means else None
    verdict = OPEN
    text = f'{analysis.choice} is chosen'
    if analysis.choice == every:
        verdict = DIFFERS
    elif gain is not None and gain.ci[0] is not None:
        verdict = AGREES if gain.ci[0] > 0 else OPEN
        text += f', {signed(gain.fit)} ({interval(gain.ci)}) against all seven'
    if above is not None:
        text += f'; {above} of {len(means) - 1} other cases have a higher mean'
    return Claim(
        'All seven sensors are beaten by smaller sets',
        '9 of 31 other cases have a higher mean',
        'the interval of what the chosen set earns more than all seven lies above 0; it does not '
        'agree where all seven are chosen',
        text,
        verdict,
    )


def _fractions_agree(campaign: StudyCampaign) -> Claim | None:
    if len(campaign.fractions) < 2:
        return None
    first, second = map(effects_of, campaign.fractions.values())
    pairs = list(zip(first, second, strict=True))
    apart = [a.factor for a, b in pairs if a.low > b.high or b.low > a.high]
    correlation = float(np.corrcoef([[a.effect, b.effect] for a, b in pairs], rowvar=False)[0, 1])
    text = f'{len(pairs) - len(apart)} of {len(pairs)} pairs of intervals overlap'
    text += f' (not {listing(apart)})' if apart else ''
    return Claim(
        "The quarter's and the eighth's effects agree",
        'the error bars of all seven overlap',
        'the 90 % intervals of all seven effects overlap; a fifth of the runs is in both '
        'fractions, which helps them to agree',
        f'{text}; correlation of the effects {number(correlation, 2)}',
        DIFFERS if apart else AGREES,
    )


def _share_fails(campaign: StudyCampaign) -> Claim:
    parts, runs = campaign.whole.two_part, len(campaign.whole.table)
    failures = parts.failures if parts else 0
    low, high = _exact_interval(failures, runs, campaign.whole.level)
    return Claim(
        'Two of ten trainings of a set fail',
        'two of ten in the case that is shown',
        'the exact 90 % interval of the share of failed runs holds 20 %',
        f'{failures} of {runs} runs failed: {percent(failures / runs, 1)} '
        f'({percent(low, 1)} to {percent(high, 1)})',
        AGREES if low <= _FAILING <= high else DIFFERS,
    )


def _exact_interval(events: int, count: int, level: float) -> tuple[float, float]:
    """Return Clopper and Pearson's interval of a share."""
    tail = (1 - level) / 2
    low = stats.beta.ppf(tail, events, count - events + 1) if events else 0.0
    high = stats.beta.ppf(1 - tail, events + 1, count - events) if events < count else 1.0
    return float(low), float(high)


def _steps_help(campaign: StudyCampaign) -> Claim | None:
    found = [_steps(name, each) for name, each in campaign.procedures.items()]
    if not found:
        return None
    verdicts = {verdict for _, verdict in found}
    return Claim(
        'Trimming and transform help the fit',
        'R² rises with each step',
        'predicted R² rises by each of the two steps, in each fraction',
        '; '.join(text for text, _ in found),
        AGREES if verdicts == {AGREES} else DIFFERS,
    )


def _steps(name: str, procedure: Pipeline) -> tuple[str, str]:
    wanted = ('initial', 'trimmed', 'transformed')
    steps = [step.fit.r2_pred for step in procedure.steps if step.name in wanted]
    known = [value for value in steps if value is not None]
    rises = len(known) == len(wanted) and all(np.diff(known) > 0)
    choice = final_outlook(procedure, np.random.default_rng(procedure.options.seed)).ranking[0]
    text = ' → '.join(number(value) for value in known)
    return f'{name}: predicted R² {text}, and {choice} is chosen', AGREES if rises else DIFFERS


def _three_confirm(campaign: StudyCampaign) -> Claim | None:
    found = campaign.whole.confirmation
    if found is None:
        return None
    best = [
        check
        for check in found.checks
        if check.label in {each.label for each in standings(campaign.whole)[:3]}
    ]
    done = [check for check in best if check.observed_mean is not None]
    if not done:
        return None
    told = [
        f'{check.label} {number(check.observed_mean)} in {interval(check.interval)}: '
        f'{"yes" if check.passed else "no"}'
        for check in done
    ]
    passed = all(check.passed for check in done)
    return Claim(
        'The three best sets confirm their predictions',
        'all three within their 90 % intervals',
        "each of the three means lies in the interval of the plan's rule",
        '; '.join(told),
        OPEN if len(done) < len(best) else AGREES if passed else DIFFERS,
    )


def _its_best_wins(campaign: StudyCampaign) -> Claim:
    analysis = campaign.whole
    ranked = standings(analysis)
    place = next((each for each in ranked if each.label == _ITS_BEST), None)
    rank = analysis.rank_uncertainty
    top = rank.groups[0] if rank else (analysis.choice,)
    text = f'{analysis.choice} comes first with {number(ranked[0].value)}'
    if place is not None and place.rank > 1:
        text += f', {_ITS_BEST} is number {place.rank} with {number(place.value)}'
        text += f' (rank {" to ".join(map(str, rank.rank_interval[_ITS_BEST]))})' if rank else ''
    return Claim(
        f'{_ITS_BEST} is the best set',
        'second by prediction, first by test',
        f'{_ITS_BEST} comes first; it cannot be told where {_ITS_BEST} is in the top group',
        text,
        AGREES if analysis.choice == _ITS_BEST else OPEN if _ITS_BEST in top else DIFFERS,
    )
