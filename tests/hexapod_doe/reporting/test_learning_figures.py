# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Curves of reward terms, names of outliers, and the glossary of a campaign of bags."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from hexapod_doe.reporting.figures import learning
from hexapod_doe.reporting.figures.learning import POINTS, outliers, reward_terms
from hexapod_doe.reporting.glossary import glossary, meanings
from hexapod_interfaces.msg import EpisodeResult
from hexapod_sim.task import TERM_NAMES


@pytest.fixture
def with_terms(campaign):
    """The campaign with a constant term and one that grows by 2 an episode."""
    curves = campaign.curves.assign(
        term_alive=600.0, term_closeness=2.0 * campaign.curves['episode']
    )
    return replace(campaign, curves=curves)


def test_outliers_are_beyond_tukeys_fences():
    # Quartiles 2 and 4, so the fences are at -1 and 7.
    assert outliers(pd.Series({1: 1.0, 2: 2.0, 3: 3.0, 4: 4.0, 5: 7.5})) == [5]
    assert outliers(pd.Series({1: 1.0, 2: 2.0, 3: 3.0, 4: 4.0, 5: 6.5})) == []


def test_a_run_far_from_its_case_is_named(campaign):
    last = campaign.curves['episode'].max()
    case = campaign.curves['case'].iloc[0]
    curves = campaign.curves.copy()
    end = (curves['episode'] == last) & (curves['case'] == case)
    curves.loc[end, 'average'] = np.where(curves.loc[end, 'replicate'] == 2, -1e4, 400.0)
    figure = learning.learning_curves(replace(campaign, curves=curves)).draw()
    panel = next(a for a in figure.axes if a.get_title(loc='left').split()[0] == str(case))
    assert [text.get_text() for text in panel.texts] == ['replicate 2']


def test_each_term_has_its_panel(with_terms):
    chart = reward_terms(with_terms)
    assert [a.get_title(loc='left') for a in chart.draw().axes] == ['alive', 'closeness']
    assert chart.data.groupby('case').size().max() <= POINTS
    assert set(chart.data['term_alive']) == {600.0}
    assert chart.title.startswith('Learning changes closeness most: by +')
    assert chart.name == 'reward_terms'


def test_without_terms_there_is_no_chart(campaign):
    assert reward_terms(campaign) is None


def test_glossary_explains_what_an_episode_result_has(campaign):
    named = ' '.join(meanings())
    skipped = {'header', 'run_id', 'episode', 'cause'}
    for field in set(EpisodeResult.get_fields_and_field_types()) - skipped:
        assert field in named or field.endswith(('_names', '_values'))
    assert {f'term_{name}' for name in TERM_NAMES} <= set(meanings())
    assert glossary(campaign).rows[0][0] == 'episode_return'
    assert glossary(replace(campaign, curves=campaign.curves.iloc[:0])) is None
