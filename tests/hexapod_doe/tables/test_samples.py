# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The shipped bags, of before metrics had names and of since: both are read and analysed."""

from pathlib import Path

import pytest
from hexapod_doe.bags.bag_file import BagFile
from hexapod_doe.bags.run_record import find_bags, is_complete, read_run
from hexapod_doe.bags.verify import verify
from hexapod_doe.tables.bag_response import default_response, response_of
from hexapod_doe.tables.bag_table import read_bags

BAGS = Path(__file__).resolve().parents[3] / 'bags'
OLD, CAMPAIGN = BAGS / 'sample', BAGS / 'sample_campaign'
NAMES = ['critic_loss', 'actor_loss', 'mean_q', 'saturated_share', 'updates']
"""The metrics that there were when the samples were recorded."""


def test_fixed_fields_of_before_are_read_by_their_names() -> None:
    run = read_run(OLD)
    ((_, first), *_) = BagFile(OLD).decoded('/hexapod/episode_result')
    assert not hasattr(first, 'metric_names')
    for name in NAMES:
        assert run.episodes[name][0] == getattr(first, name)
    assert run.evaluation.empty
    assert default_response([run]) == 'final_average_reward'
    assert response_of(run, 'final_average_reward') == first.average_return / 2 + (
        run.episodes['episode_return'][1] / 2
    )


def test_the_sample_campaign_is_whole_and_names_its_metrics() -> None:
    bags = find_bags(CAMPAIGN)
    assert len(bags) == 8
    for bag in bags:
        verify(bag)
        assert is_complete(bag)
    run = read_run(bags[0])
    assert set(NAMES) <= set(run.episodes)
    assert len(run.evaluation) == int(run.metadata['evaluation']) == 4
    assert float(run.metadata['evaluation_return']) == pytest.approx(
        run.evaluation['episode_return'].mean()
    )


def test_the_sample_campaign_is_a_table_of_evaluations() -> None:
    (table,) = read_bags([CAMPAIGN], 'ABC')
    assert table.response == 'evaluation_return'
    assert len(table.rows) == 8
    (trained,) = read_bags([CAMPAIGN], 'ABC', 'final_average_reward')
    assert (table.values != trained.values).all()
