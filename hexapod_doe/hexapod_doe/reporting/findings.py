# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The tables of the report that go beyond the fitted model: other views, failures, purchase."""

import dataclasses

import pandas as pd

from hexapod_doe.designs.terms import CONSTANT
from hexapod_doe.records.results import Analysis
from hexapod_doe.reporting.formats import (
    aligned,
    capitalised,
    chance,
    interval,
    number,
    percent,
    plain,
)
from hexapod_doe.reporting.standing import standings
from hexapod_doe.reporting.tables import Table

SHOWN = 12
"""Rows of a long table on the page; its CSV holds them all."""


def choices(analysis: Analysis) -> Table | None:
    """Tabulate what each way to look at the same runs would choose."""
    rows = [('final model', 'all runs alike', analysis.ranking[0])]
    if analysis.two_part is not None:
        rows.append(
            ('two parts', 'reward, weighed by the chance to fail', analysis.two_part.choice)
        )
    rows += [(e.name, e.description, e.choice) for e in analysis.estimands]
    if analysis.averaging is not None:
        text = f'average over {analysis.averaging.models} models'
        rows.append(('averaged', text, analysis.averaging.choice))
    rows += [
        (f'{other.design.name} alone', other.choice_rule, other.choice)
        for other in analysis.compared
    ]
    if len(rows) == 1:
        return None
    ranks = {standing.label: standing.rank for standing in standings(analysis)}
    agree = sum(choice == analysis.choice for *_, choice in rows)
    return Table(
        'choices',
        f'{agree} of {len(rows)} ways to look at the runs choose {analysis.choice}',
        'The last column is the rank of that choice by the model that decides.',
        {
            'view': [view for view, *_ in rows],
            'what it weighs': [text for _, text, _ in rows],
            'choice': [choice for *_, choice in rows],
            'rank': [f'{ranks.get(choice, "")}' for *_, choice in rows],
        },
        pd.DataFrame(rows, columns=['view', 'description', 'choice']),
    )


def attribution(analysis: Analysis) -> Table | None:
    """Tabulate which set wins under which share of the namings of confounded sums."""
    found = analysis.attribution
    if found is None or not found.ambiguous:
        return None
    total = sum(found.winners.values())
    winners = sorted(found.winners, key=lambda label: (-found.winners[label], label))
    same = 'The winner does not depend' if len(winners) == 1 else 'The winner depends'
    labels = list(found.rank_range)
    return Table(
        'attribution',
        f'{same} on how confounded sums are named',
        f'{found.examined} of {found.attributions} namings fit every run equally well; '
        f'{len(found.safe)} of {len(analysis.predictions)} predictions are the same under all.',
        {
            'set': winners[:SHOWN],
            'wins in': [f'{found.winners[label]}' for label in winners[:SHOWN]],
            'share': [percent(found.winners[label] / total) for label in winners[:SHOWN]],
            'ranks': [' to '.join(map(str, found.rank_range[w])) for w in winners[:SHOWN]],
            'predicted': [interval(found.fit_range[label]) for label in winners[:SHOWN]],
        },
        pd.DataFrame(
            {
                'label': labels,
                'wins': [found.winners.get(label, 0) for label in labels],
                'rank_low': [found.rank_range[label][0] for label in labels],
                'rank_high': [found.rank_range[label][1] for label in labels],
                'fit_low': [found.fit_range[label][0] for label in labels],
                'fit_high': [found.fit_range[label][1] for label in labels],
            }
        ),
    )


def failure_model(analysis: Analysis) -> Table | None:
    """Tabulate what makes trainings fail."""
    parts = analysis.two_part
    if parts is None or not parts.failures:
        return None
    terms = [term for term in parts.failure_terms if term != CONSTANT]
    coef = [parts.failure_coef[term] for term in terms]
    error = [parts.failure_se[term] for term in terms]
    return Table(
        'failure_model',
        f'{parts.failures} of {parts.runs} trainings failed',
        f'Below {number(parts.threshold)}: {capitalised(parts.threshold_rule).rstrip(".")}. '
        'Log-odds of failure per coded unit: negative protects.',
        {
            'term': terms,
            'log-odds': aligned(coef, sign=True),
            'standard error': aligned(error),
        },
        pd.DataFrame({'term': terms, 'log_odds': coef, 'se': error}),
    )


def two_part(analysis: Analysis) -> Table | None:
    """Tabulate chance of failure and reward of success for the sets of highest expectation."""
    parts = analysis.two_part
    if parts is None or not parts.failures:
        return None
    shown = parts.ranking[:SHOWN]
    return Table(
        'two_part',
        'Reward weighed by the chance to fail',
        f'The {len(shown)} best of {len(parts.ranking)} sets, in the order of the reduced models, '
        'which choose; the other columns come from the full ones, which state. A failed training '
        f'earns {number(parts.mean_failed)} on average.',
        {
            'set': shown,
            'reduced models': aligned([parts.selected[label] for label in shown], 4),
            'P(failure)': [percent(parts.p_failure[label].fit) for label in shown],
            'if it succeeds': aligned([parts.reward_success[label].fit for label in shown], 4),
            'expected': aligned([parts.expected[label].fit for label in shown], 4),
            'interval': [interval(parts.expected[label].ci) for label in shown],
        },
        pd.DataFrame(
            {
                'label': label,
                'selected': parts.selected[label],
                'p_failure': parts.p_failure[label].fit,
                'reward_success': parts.reward_success[label].fit,
                'expected': parts.expected[label].fit,
                'expected_low': parts.expected[label].ci[0],
                'expected_high': parts.expected[label].ci[1],
            }
            for label in parts.ranking
        ),
    )


def averaging(analysis: Analysis) -> Table | None:
    """Tabulate the probability that each term is active, over many models."""
    found = analysis.averaging
    if found is None:
        return None
    active = sorted(found.p_active.items(), key=lambda item: -item[1])
    return Table(
        'averaging',
        'How likely each term is active',
        f'Over {found.models} models, weighed by how well they fit for their size.',
        {
            'term': [term for term, _ in active[:SHOWN]],
            'P(active)': [percent(p) for _, p in active[:SHOWN]],
        },
        pd.DataFrame(active, columns=['term', 'p_active']),
    )


def confirmation(analysis: Analysis) -> Table | None:
    """Tabulate the confirmation runs against the interval that was stated before them."""
    found = analysis.confirmation
    if found is None:
        return None
    verdict = {None: 'not run', True: 'confirmed', False: 'not confirmed'}
    judged = [check.passed for check in found.checks if check.passed is not None]
    return Table(
        'confirmation',
        f'{sum(judged)} of {len(judged)} sets confirmed' if judged else 'What would confirm them',
        found.rule,
        {
            'set': [check.label for check in found.checks],
            'predicted': aligned([check.predicted for check in found.checks], 4),
            'mean must lie in': [interval(check.interval) for check in found.checks],
            'runs': [f'{len(check.observed)} of {check.runs}' for check in found.checks],
            'observed mean': aligned([check.observed_mean for check in found.checks], 4),
            'verdict': [verdict[check.passed] for check in found.checks],
        },
        pd.DataFrame([dataclasses.asdict(check) for check in found.checks]),
    )


def devices(analysis: Analysis) -> Table | None:
    """Tabulate the devices and what they yield."""
    if analysis.purchase is None:
        return None
    found = analysis.purchase.devices
    return Table(
        'devices',
        'Devices',
        f'Cost in {analysis.purchase.currency}, mass in kg, power in W; the last column is the '
        'chance that the device breaks in one mission.',
        {
            'device': [device.name for device in found],
            'yields': [device.yields for device in found],
            'cost': [plain(device.cost) for device in found],
            'mass': [plain(device.mass) for device in found],
            'power': [plain(device.power) for device in found],
            'breaks': [percent(device.failure_probability, 1) for device in found],
        },
        pd.DataFrame([dataclasses.asdict(device) for device in found]),
    )


def front(analysis: Analysis) -> Table | None:
    """Tabulate the sets that no cheaper one beats."""
    if analysis.purchase is None:
        return None
    by_label = {priced.label: priced for priced in analysis.purchase.sets}
    members = [by_label[label] for label in analysis.purchase.front]
    return Table(
        'front',
        'Sets that no cheaper one beats',
        f'P(front): share of draws in which that holds. P(not worse): chance to be at most '
        f'{number(analysis.purchase.delta)} below the best.',
        {
            'set': [member.label for member in members],
            f'cost,\N{NO-BREAK SPACE}{analysis.purchase.currency}': [
                plain(member.cost) for member in members
            ],
            'predicted': aligned([member.fit for member in members], 4),
            'interval': [interval(member.ci) for member in members],
            'P(front)': [chance(member.p_front) for member in members],
            'P(not worse)': [chance(member.p_not_worse) for member in members],
            'devices': [', '.join(member.devices) for member in members],
        },
        pd.DataFrame([dataclasses.asdict(member) for member in members]),
    )


def breakage(analysis: Analysis) -> Table | None:
    """Tabulate what is lost when one device breaks."""
    if analysis.purchase is None or not analysis.purchase.breakage:
        return None
    found = analysis.purchase.breakage
    return Table(
        'breakage',
        'What is lost when a device breaks',
        'The robot is trained again without what the device yields.',
        {
            'set': [item.label for item in found],
            'device': [item.device for item in found],
            'loses': [item.lost for item in found],
            'remaining': [item.remaining for item in found],
            'predicted': aligned([item.fit for item in found], 4),
            'loss': aligned([item.loss for item in found], 4),
            'interval of the loss': [interval(item.loss_ci) for item in found],
        },
        pd.DataFrame([dataclasses.asdict(item) for item in found]),
    )
