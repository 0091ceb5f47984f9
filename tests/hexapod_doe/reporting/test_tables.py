# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Tables hold the numbers of the analysis, in full in their files and rounded on the page."""

from dataclasses import replace
from pathlib import Path

import pandas as pd
import pytest
from hexapod_doe.analysis.analysis import analyse
from hexapod_doe.records.options import Options
from hexapod_doe.reporting import findings, models, tables
from hexapod_doe.reporting.tables import Table
from hexapod_doe.tables.csv_table import read_csv

CASES = Path(__file__).parents[2] / 'data' / 'cases'

MAKERS = [
    tables.predictions, models.steps, models.model_terms, models.elimination, tables.aliases,
    models.anova,
    tables.main_effects, tables.runs, models.checks, models.transform, findings.choices,
    findings.attribution, findings.failure_model, findings.two_part, findings.averaging,
    findings.confirmation, findings.devices, findings.front, findings.breakage,
]  # fmt: skip


@pytest.mark.parametrize('make', MAKERS, ids=lambda make: make.__name__)
@pytest.mark.parametrize('name', ['tour', 'campaign', 'article'])
def test_every_table_is_whole(request, name, make, tmp_path):
    table = make(request.getfixturevalue(name))
    if table is None:
        return
    assert isinstance(table, Table)
    assert table.rows
    assert all(isinstance(cell, str) for row in table.rows for cell in row)
    table.save(tmp_path)
    assert len(pd.read_csv(tmp_path / f'{table.name}.csv')) == len(table.data)


def test_the_campaign_has_every_table_but_a_transform(campaign):
    missing = [make.__name__ for make in MAKERS if make(campaign) is None]
    assert set(missing) <= {'transform', 'elimination'}


def test_each_term_is_printed_with_its_alias_string(tour):
    names = models.model_terms(tour).cells['term']
    assert names[0] == 'constant'
    first = replace(tour, steps=tour.steps[:1])
    assert 'AB + CE + FG' in models.model_terms(first).cells['term']


def test_missing_numbers_are_dashes(tour):
    first = replace(tour, steps=tour.steps[:1])  # saturated: no error
    cells = models.model_terms(first).cells
    assert set(cells['standard error']) == set(cells['p']) == {'–'}


def test_the_aliases_of_the_eighth_are_its_seven_sums(tour):
    sums = tables.aliases(tour).cells['sum']
    pairs = [text for text in sums if len(text.split(' + ')[0]) == 2]
    assert len(pairs) == 7
    assert pairs[0] == 'AB + CE + FG'


def test_predictions_keep_full_precision_and_both_models(campaign):
    data = tables.predictions(campaign).data.set_index('label')
    for p in campaign.predictions:
        assert data.loc[p.label, 'final_model_fit'] == p.fit
        assert data.loc[p.label, 'value'] == campaign.two_part.selected[p.label]


def test_choices_count_the_views_that_agree(campaign):
    table = findings.choices(campaign)
    agree = table.cells['choice'].count(campaign.choice)
    assert table.title.startswith(f'{agree} of {len(table.rows)} ways')


def test_confirmation_runs_are_judged(campaign):
    check = replace(
        campaign.confirmation.checks[0], observed=(1.0,), observed_mean=1.0, passed=True
    )
    rule = replace(campaign.confirmation, checks=(check, *campaign.confirmation.checks[1:]))
    table = findings.confirmation(replace(campaign, confirmation=rule))
    assert table.title == '1 of 1 sets confirmed'
    assert table.cells['verdict'][0] == 'confirmed'
    assert table.cells['verdict'][1] == 'not run'
    assert findings.confirmation(campaign).title == 'What would confirm them'


def test_what_an_irregular_design_mixes_is_tabulated(campaign):
    assert tables.alias_matrix(campaign) is None
    (table,) = read_csv(CASES / 's11_plackett_burman_12.csv', 'y')
    made = tables.alias_matrix(analyse([table], Options()))
    assert made.cells['holds'][0] == (
        'A - 0.33·BC - 0.33·BD - 0.33·BE + 0.33·BF - 0.33·BG - 0.33·BH + 0.33·BJ + 38 more'
    )
    assert len(made.data) == 11 * 45
