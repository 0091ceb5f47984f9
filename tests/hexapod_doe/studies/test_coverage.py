# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import numpy as np
import pytest
from coverage_study import COMPARED, STATED, Study, Tally
from scenarios import SCENARIOS


def test_a_tally_counts_what_lies_within_its_bounds() -> None:
    tally = Tally()
    bounds = [(0.0, 1.0), (0.0, 1.0), (None, 1.0), (2.0, 3.0)]
    tally.cover(STATED, 'x', 0.9, bounds, np.array([0.5, 1.5, 0.5, 2.5]))
    assert tally.coverage[STATED, 'x', 0.9] == [pytest.approx(2 / 3)]


def test_one_campaign_judges_every_statement() -> None:
    tally = Study(SCENARIOS['failures']()).run(1, seed=1)
    table = tally.coverage_table()
    assert (table['kind'] == STATED).sum() == 11
    assert set(tally.choices) == {
        'two-part', 'averaged over models', 'final model, all runs',
        "article's, worst three dropped",
    }  # fmt: skip
    assert len(tally.claims) == 2


def test_blocks_and_centre_points_are_judged_at_the_corners() -> None:
    study = Study(SCENARIOS['curvature-in-blocks']())
    assert study.mean.max() == 460  # the curvature of 60 is at the centre alone
    table = study.run(1, seed=1).coverage_table()
    assert table['coverage'].between(0, 1).all()


def test_the_design_of_plackett_and_burman_is_orthogonal() -> None:
    levels = SCENARIOS['plackett-burman']().levels.drop_duplicates().to_numpy()
    assert levels.shape == (12, 6)
    assert np.array_equal(levels.T @ levels, 12 * np.eye(6))


@pytest.mark.slow
@pytest.mark.timeout(3600)
def test_stated_intervals_cover_and_the_choice_is_good() -> None:
    """100 campaigns of 320 runs, a fifth of which fail: the tables of docs/statistics.md."""
    tally = Study(SCENARIOS['failures']()).run(100, seed=1)
    coverage = tally.coverage_table()
    stated = coverage[coverage['kind'] == STATED]
    assert (stated['coverage'] - stated['nominal']).between(-0.03, 0.05).all()
    choices = tally.choice_table().set_index('rule')
    article = choices.loc["article's, worst three dropped"]
    assert choices.loc['two-part', 'regret'] <= article['regret'] + 1
    claims = tally.claim_table().set_index('claim')
    assert (claims['true'] >= claims['claimed'] - 0.06).all()
    compared = coverage[coverage['kind'] == COMPARED].set_index('interval')['coverage']
    assert compared["article's CI, for the mean of all runs"] < 0.5


@pytest.mark.slow
@pytest.mark.timeout(3600)
@pytest.mark.parametrize('name', sorted(set(SCENARIOS) - {'failures', 'no-failures'}))
def test_the_mean_is_covered_in_every_scenario(name: str) -> None:
    coverage = Study(SCENARIOS[name]()).run(40, seed=1).coverage_table().set_index('interval')
    mean = coverage.loc['mean of the runs']
    assert mean['coverage'] >= 0.9 - 0.03 - 2 * mean['error']
