# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The report's sentences follow from the data."""

from dataclasses import replace

import pandas as pd
import pytest
from hexapod_doe.records.findings import Estimate
from hexapod_doe.reporting import text
from hexapod_doe.reporting.figures import predictions
from hexapod_doe.tables.table import CURVE_COLUMNS


def _with(analysis, episodes, replicates):
    curves = pd.DataFrame({'run_id': 'a', 'episode': range(episodes)})
    design = replace(analysis.design, replicates=(replicates, replicates))
    return replace(analysis, curves=curves, design=design)


@pytest.mark.parametrize(
    ('episodes', 'replicates', 'start'),
    [
        (1, 1, 'One episode is a tour, not a conclusion'),
        (4, 1, 'Four episodes are a tour, not a conclusion'),
        (50, 10, '50 episodes are a tour, not a conclusion'),
        (300, 10, '300 episodes are an interim result'),
        (1000, 1, 'One run per case is a sketch'),
        (1000, 2, 'Two runs per case are few'),
    ],
)
def test_little_data_is_said_first(tour, episodes, replicates, start):
    assert text.caution(_with(tour, episodes, replicates)).startswith(start)


def test_enough_data_need_no_caution(tour):
    assert text.caution(_with(tour, 1000, 10)) == ''


def test_a_table_without_curves_is_judged_by_its_replicates(tour):
    bare = replace(tour, curves=pd.DataFrame(columns=CURVE_COLUMNS))
    assert text.episodes(bare) is None
    assert text.caution(bare).startswith('One run per case')


def test_chance_is_named_only_where_runs_are_single(tour):
    assert 'chance passes for an effect' in text.caution(_with(tour, 4, 1))
    assert 'chance passes' not in text.caution(_with(tour, 4, 2))


def test_a_model_that_predicts_nothing_chooses_nothing(tour):
    final = replace(tour.final, r2_pred=-0.2)
    blind = replace(tour, steps=(*tour.steps[:-1], final))
    assert text.headline(blind).startswith('No set of sensors stands out yet; ')
    assert any('worse than their mean' in sentence for sentence in text.sureness(blind))


def test_a_saturated_model_cannot_say_how_sure_it_is(tour):
    saturated = replace(tour, steps=tour.steps[:1])
    assert text.headline(saturated).endswith('comes first; how surely, these runs cannot say')
    assert any('no error left' in sentence for sentence in text.sureness(saturated))


def test_a_model_without_terms_sees_no_difference(tour):
    same = tuple(replace(p, fit=1.0) for p in tour.predictions)
    blank = replace(tour, predictions=same)
    assert text.headline(blank) == 'These runs show no difference between the sets of sensors'
    assert text.facts(blank)[2].label == 'sets not told from it'
    assert predictions.top_sets(blank).title == 'All sets are predicted alike'
    assert predictions.ranked_predictions(blank).title == 'All sets are predicted alike'


def test_an_ambiguous_winner_is_called_one(campaign):
    assert campaign.attribution.ambiguous
    unsafe = replace(campaign.attribution, safe=(), winners={'ABCDE': 2, 'BCDE': 1})
    sentences = text.sureness(replace(campaign, attribution=unsafe))
    warning = next(s for s in sentences if 'confounded sum' in s)
    assert ' + ' in warning
    assert 'ABCDE in 2 of 3 and BCDE in 1 of 3' in warning


def test_the_foot_names_the_options_that_were_set(tour):
    line = text.settings(tour)
    assert 'alpha 0.05' in line
    assert 'hierarchy true' in line
    assert 'None' not in line


def test_a_model_that_predicts_names_its_choice(campaign):
    assert campaign.final.r2_pred > 0
    assert text.headline(campaign) == f'Choose {campaign.choice}'


def test_the_chosen_set_is_spelled_out(campaign):
    chosen = text.chosen_standing(campaign)
    words = text.description(campaign, chosen)
    on = [campaign.design.factor_names[f] for f, level in chosen.levels.items() if level > 0]
    assert 'body orientation' in words
    assert all(name in words for name in on)
    nothing = replace(chosen, levels=dict.fromkeys('ABCDEFG', -1))
    assert text.description(campaign, nothing) == 'only what is always observed'
    assert text.name_of(campaign, nothing) == 'no optional sensor'


def test_the_facts_are_those_of_the_model_that_decides(campaign):
    assert campaign.two_part is not None
    predicted, *_ = text.facts(campaign)
    value = campaign.two_part.selected[campaign.choice]
    assert predicted.value == f'{value:.0f}'


def test_a_gain_is_a_number_only_where_its_interval_tells_it(campaign):
    told = replace(campaign, against_all=Estimate(824.0, (12.0, 1600.0)))
    gain = text.facts(told)[1]
    assert gain.value == '+824'
    assert '90 % interval 12.0 to 1600; all: ' in gain.note
    vague = replace(campaign, against_all=Estimate(824.0, (-12.0, 1600.0)))
    gain = text.facts(vague)[1]
    assert gain.value == 'no difference told'
    assert gain.note == '+824, 90 % interval −12.0 to 1600'
    assert text.facts(replace(campaign, against_all=None))[1].value == '–'


@pytest.mark.parametrize(('p', 'told'), [(0.97, True), (0.48, False)])
def test_a_cheapest_set_is_named_only_with_the_confidence_asked_for(campaign, p, told):
    bought = campaign.purchase.cheapest
    sets = tuple(
        replace(s, p_not_worse=p) if s.label == bought else s for s in campaign.purchase.sets
    )
    purchase = replace(campaign.purchase, sets=sets, confidence=0.9)
    fact = text.facts(replace(campaign, purchase=purchase))[-1]
    assert (fact.value == bought) == told
    assert f'{100 * p:.0f}' in fact.note
    assert bought in f'{fact.value} {fact.note}'


def test_an_untrained_choice_is_called_a_prediction(campaign):
    untested = replace(
        campaign, predictions=tuple(replace(p, tested=False) for p in campaign.predictions)
    )
    assert any('was not trained' in sentence for sentence in text.sureness(untested))
    tested = replace(
        campaign, predictions=tuple(replace(p, tested=True) for p in campaign.predictions)
    )
    assert not any('was not trained' in sentence for sentence in text.sureness(tested))
