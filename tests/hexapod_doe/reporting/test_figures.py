# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Figures draw the numbers of the analysis, and their titles say what those numbers say."""

from dataclasses import replace

import matplotlib as mpl
import numpy as np
import pytest
from hexapod_doe.fitting.alias_matrix import short_alias
from hexapod_doe.reporting.figures import (
    effects,
    learning,
    predictions,
    purchase,
    residuals,
    significance,
)
from hexapod_doe.reporting.figures.chart import Chart
from hexapod_doe.reporting.figures.style import RC, ROLES
from hexapod_doe.reporting.standing import standings


def _axes(chart: Chart):
    with mpl.rc_context(RC):
        return chart.draw().axes


def test_main_effects_are_means_with_and_without(campaign):
    chart = effects.main_effects(campaign)
    own = chart.data[chart.data['design'] == campaign.design.name].set_index('factor')
    table = campaign.table
    for factor in 'ABCDEFG':
        with_, without = (table.loc[table[factor] == level, 'response'] for level in (1, -1))
        for kind in ('fitted', 'raw_mean'):  # the same in a balanced campaign
            assert own[f'{kind}_with'][factor].iloc[0] == pytest.approx(with_.mean())
            assert own[f'{kind}_without'][factor].iloc[0] == pytest.approx(without.mean())
        assert own['se_fitted_with'][factor].iloc[0] == pytest.approx(
            campaign.steps[0].s * np.sqrt(2 / len(table))
        )
    assert chart.title.startswith('C (body orientation) moves the response most')
    assert len(chart.data) == 14


def test_an_effect_within_noise_is_not_announced(tour):
    assert effects.main_effects(tour).title.startswith('No sensor stands out from noise')
    assert effects.interactions(tour).title.startswith('No interaction is significant')


def test_interactions_are_means_at_four_corners(campaign):
    chart = effects.interactions(campaign)
    table = campaign.table
    for row in chart.data.to_dict('records'):
        first, second = row['term']
        cell = table[(table[first] == row['first']) & (table[second] == row['second'])]
        assert row['mean'] == pytest.approx(cell['response'].mean())


def test_without_replicates_lenths_margins_are_the_limits(tour):
    found = significance.sizes(tour)
    assert [value for _, value in found.limits] == [
        tour.lenth.margin,
        tour.lenth.simultaneous_margin,
    ]
    assert len(found.data) == 15
    assert set(found.active) == set(tour.lenth.clearly_active)


def test_with_replicates_t_values_are_held_against_their_limit(campaign):
    found = significance.sizes(campaign)
    step = campaign.steps[0]
    sizes = dict(zip(found.data['term'], found.data['size'], strict=True))
    assert sizes == pytest.approx({t: abs(v) for t, v in step.t.items() if t != '1'})
    # 96 runs, 16 terms: t(.975, 80) = 1.9901 (tables).
    assert found.limits[0][1] == pytest.approx(1.9901, abs=1e-4)
    assert 'C' in found.active


def test_half_normal_quantiles_follow_their_definition(campaign):
    # The middle of 15 ordered effects sits at the median of |N(0, 1)|, 0.6745.
    data = significance.half_normal(campaign).data
    assert data['size'].is_monotonic_increasing
    assert data['quantile'].iloc[7] == pytest.approx(0.6745, abs=1e-4)


def test_the_histogram_has_twenty_bins_of_all_runs(campaign):
    chart = residuals.histogram(campaign, campaign.final)
    assert len(chart.data) == 20
    assert chart.data['runs'].sum() == campaign.final.n
    assert 'lean to the left' in chart.title  # failed runs


def test_residuals_come_with_their_runs(campaign):
    chart = residuals.against_order(campaign, campaign.final)
    runs = campaign.table.set_index('run_id')
    order = runs.loc[chart.data['run_id'], 'run_order']
    assert chart.data['run_order'].tolist() == order.tolist() == list(range(1, 97))
    assert chart.data['residual'].sum() == pytest.approx(0, abs=1e-6)


def test_ranked_predictions_hold_every_set_of_every_design(campaign):
    chart = predictions.ranked_predictions(campaign)
    assert len(chart.data) == 256
    first = chart.data.iloc[0]
    assert first['label'] == standings(campaign)[0].label == campaign.choice


def test_the_top_sets_end_with_all_sensors_and_none(campaign):
    labels = predictions.top_sets(campaign).data['label'].tolist()
    assert labels[:15] == [s.label for s in standings(campaign)[:15]]
    assert {'ABCDEFG', '(none)'} <= set(labels)
    matrix, _ = _axes(predictions.top_sets(campaign))
    assert [text.get_text() for text in matrix.get_xticklabels()] == list('ABCDEFG')


def test_agreement_needs_another_design(campaign, tour):
    assert predictions.agreement(tour) is None
    assert len(predictions.agreement(campaign).data) == 128


def test_runs_that_failed_are_counted(campaign, tour):
    failures = int((campaign.table['response'] < campaign.two_part.threshold).sum())
    assert learning.runs_by_case(campaign).title == f'{failures} of 96 runs failed'
    assert learning.runs_by_case(tour).title.startswith('16 runs, one of each case')


def test_many_sets_are_drawn_as_a_band_and_many_cases_without_names(tour, monkeypatch):
    monkeypatch.setattr(predictions, 'MAX_BARS', 100)
    monkeypatch.setattr(learning, 'MAX_NAMES', 10)
    monkeypatch.setattr(learning, 'MAX_PANELS', 8)
    band = _axes(predictions.ranked_predictions(tour))[0].collections
    assert type(band[0]).__name__ == 'FillBetweenPolyCollection'
    assert len(_axes(learning.runs_by_case(tour))[0].get_yticks()) == 0
    curves = learning.learning_curves(tour)
    assert len(_axes(curves)) == 8
    assert 'The 8 best cases' in curves.caption
    means = tour.table.groupby('case')['response'].mean()
    assert set(curves.data['case']) == set(means.nlargest(8).index)


def test_learning_curves_have_a_panel_per_case(campaign, tour):
    chart = learning.learning_curves(campaign)
    assert len(_axes(chart)) == 16
    assert chart.data.groupby('run_id').size().max() <= learning.POINTS
    ends = chart.data.groupby('run_id')['episode'].agg(['min', 'max'])
    assert (ends['min'] == 0).all()
    assert (ends['max'] == 599).all()
    assert learning.learning_curves(replace(tour, curves=tour.curves.iloc[:0])) is None


def test_the_cost_front_names_the_purchase(campaign):
    chart = purchase.cost_front(campaign)
    assert campaign.purchase.cheapest in chart.title
    assert len(chart.data) == 128
    assert purchase.cost_front(replace(campaign, purchase=None)) is None


def test_a_drawing_keeps_no_colour_of_its_own(campaign):
    svg = effects.main_effects(campaign).svg
    assert svg.startswith('<svg')
    assert not any(light in svg for light, _ in ROLES.values())
    assert ' width="' not in svg[: svg.index('>')]


def test_light_and_dark_colours_can_be_read():
    # WCAG 2: text needs a contrast of 4.5, here of every role against the surface of its theme.
    for theme in (0, 1):
        surface = _luminance(ROLES['surface'][theme])
        for role in ('ink', 'muted', 'blue', 'orange', 'teal', 'purple'):
            colour = _luminance(ROLES[role][theme])
            low, high = sorted((surface, colour))
            assert (high + 0.05) / (low + 0.05) >= 4.5, (role, theme)


def _luminance(colour):
    # Relative luminance of sRGB, WCAG 2.1.
    channels = np.array([int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)])
    linear = np.where(channels <= 0.04045, channels / 12.92, ((channels + 0.055) / 1.055) ** 2.4)
    return float(linear @ [0.2126, 0.7152, 0.0722])


def test_long_alias_strings_are_cut():
    assert short_alias('AB + CE + FG') == 'AB + CE + FG'
    assert short_alias('ABD + ACF + AEG + BCG + BEF') == 'ABD + ACF + AEG + 2 more'
    assert short_alias('AB - CD') == 'AB - CD'
