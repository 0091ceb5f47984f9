# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import numpy as np
import pytest
from hexapod_doe.designs.design import fraction
from hexapod_doe.studies.coverage import Study
from hexapod_doe.studies.simulated import Truth
from hexapod_doe.studies.tally import COMPARED, STATED, Tally


def test_a_tally_counts_what_lies_within_its_bounds() -> None:
    tally = Tally()
    bounds = [(0.0, 1.0), (0.0, 1.0), (None, 1.0), (2.0, 3.0)]
    tally.cover(STATED, 'x', 0.9, bounds, np.array([0.5, 1.5, 0.5, 2.5]))
    assert tally.coverage[STATED, 'x', 0.9] == [pytest.approx(2 / 3)]


def test_one_campaign_judges_every_statement() -> None:
    tally = Study(Truth(), fraction('quarter'), 10).run(1, seed=1)
    table = tally.coverage_table()
    assert (table['kind'] == STATED).sum() == 11
    assert set(tally.choices) == {
        'two-part', 'averaged over models', 'final model, all runs',
        "article's, worst three dropped",
    }  # fmt: skip
    assert len(tally.claims) == 2


@pytest.mark.slow
@pytest.mark.timeout(3600)
def test_stated_intervals_cover_and_the_choice_is_good() -> None:
    """200 campaigns of 320 runs, a fifth of which fail: the tables of docs/statistics.md."""
    tally = Study(Truth(), fraction('quarter'), 10).run(200, seed=1)
    coverage = tally.coverage_table()
    stated = coverage[coverage['kind'] == STATED]
    assert (stated['coverage'] - stated['nominal']).abs().max() <= 0.03
    choices = tally.choice_table().set_index('rule')
    article = choices.loc["article's, worst three dropped"]
    assert choices.loc['two-part', 'regret'] <= article['regret']
    assert choices.loc['two-part', 'best'] >= article['best']
    claims = tally.claim_table().set_index('claim')
    assert (claims['true'] >= claims['claimed'] - 0.06).all()
    compared = coverage[coverage['kind'] == COMPARED].set_index('interval')['coverage']
    assert compared["article's CI, for the mean of all runs"] < 0.5
