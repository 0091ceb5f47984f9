# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""All numbers of a study as one record of plain values, from which its texts are written."""

from collections.abc import Mapping
from typing import Any

import pandas as pd

from hexapod_doe.analysis.analysis_json import to_json
from hexapod_doe.records.results import Analysis
from hexapod_doe.reporting.standing import standings
from hexapod_doe.studies.claims import claims_of
from hexapod_doe.studies.study_data import ARTICLE, MAIN, Study, StudyCampaign, effects_of

SCHEMA = 'hexapod_doe/study/1'
_SHOWN = 5
_DIGITS = 9


def numbers_of(study: Study, backtest: pd.DataFrame | None, rule: str) -> dict[str, Any]:
    """Return the record of a study: `campaigns`, `claims`, `robust`, `backtest`, `left_out`.

    Args:
        study: The finished campaigns.
        backtest: Of the main campaign, if it is finished.
        rule: Its rule of thumb.
    """
    asked = [study.campaigns[name] for name in (MAIN, ARTICLE) if name in study.campaigns]
    record = {
        'schema': SCHEMA,
        'left_out': list(study.left_out),
        'campaigns': {name: _campaign(each) for name, each in study.campaigns.items()},
        'claims': {each.name: claims_of(each) for each in asked},
        'robust': _robust(study.tasks),
        'backtest': None
        if backtest is None
        else {'rule': rule, 'table': backtest.to_dict('list')},
    }
    return dict(_rounded(to_json(record)))


def _campaign(campaign: StudyCampaign) -> dict[str, Any]:
    whole = campaign.whole
    ranked = standings(whole)
    rank = whole.rank_uncertainty
    return {
        'runs': whole.design.runs,
        'cases': whole.design.cases,
        'replicates': whole.design.replicates,
        'episodes': int(whole.curves.groupby('run_id')['episode'].nunique().max()),
        'response': whole.response,
        'level': whole.level,
        'failures': whole.two_part.failures if whole.two_part else 0,
        'best': [
            {'set': each.label, 'value': each.value, 'ci': each.ci} for each in ranked[:_SHOWN]
        ],
        'p_best': None if rank is None else rank.p_best.get(whole.choice),
        'expected_loss': whole.expected_loss,
        'top_group': list(rank.groups[0]) if rank else [],
        'against_all': whole.against_all,
        'cheapest': _cheapest(whole),
        'effects': {
            name: {effect.factor: effect for effect in effects_of(each)}
            for name, each in campaign.fractions.items()
        },
        'factors': dict(whole.design.factor_names),
        'confirmation': whole.confirmation,
        'values': {each.label: each.value for each in ranked},
        'caveats': whole.caveats,
        'made': _made(campaign.made),
    }


def _cheapest(analysis: Analysis) -> dict[str, Any] | None:
    purchase = analysis.purchase
    if purchase is None:
        return None
    found = next(each for each in purchase.sets if each.label == purchase.cheapest)
    return {
        'set': found.label,
        'cost': found.cost,
        'currency': purchase.currency,
        'value': found.fit,
        'ci': found.ci,
        'delta': purchase.delta,
        'p_not_worse': found.p_not_worse,
    }


def _made(made: pd.DataFrame) -> dict[str, Any]:
    """Return what all runs were made with, and when."""
    return {
        'commits': sorted(made['git_commit'].unique()),
        'processors': sorted(made['processor'].unique()),
        'machines': sorted(made['machine'].unique()),
        'began': made['recording_began'].min()[:10],
        'ended': made['recording_ended'].max()[:10],
    }


def _robust(tasks: Mapping[str, StudyCampaign]) -> dict[str, Any] | None:
    """Return the set that loses least in its worst task, in shares of each task's best."""
    if len(tasks) < 2:
        return None
    values = pd.DataFrame(
        {
            name: {each.label: each.value for each in standings(campaign.first[1])}
            for name, campaign in tasks.items()
        }
    )
    lost = (values.max() - values) / values.max().abs()
    best = str(lost.max(axis=1).idxmin())
    own = dict(zip(map(str, lost), map(float, lost.loc[[best]].to_numpy()[0]), strict=True))
    return {'set': best, 'worst_task': max(own, key=own.__getitem__), 'lost': own}


def _rounded(value: Any) -> Any:
    """Return numbers with digits that every machine agrees on."""
    if isinstance(value, dict):
        return {key: _rounded(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_rounded(item) for item in value]
    return float(f'{value:.{_DIGITS}g}') if isinstance(value, float) else value
