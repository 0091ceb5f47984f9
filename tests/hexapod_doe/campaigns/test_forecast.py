# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import pytest
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_doe.campaigns.forecast import SECONDS_PER_STEP, forecast


@pytest.mark.parametrize(
    ('due', 'episodes', 'workers', 'told'),
    [
        # 320 runs x 1000 episodes x 600 steps at 3.7 ms on two cores are 98.7 h.
        (320, 1000, 2, '320 runs of 1000 episodes to train, 2 at a time: about 99 h'),
        (16, 4, 2, 'about 1 min'),
        (1, 1000, 8, 'one at a time: about 37 min'),
    ],
)
def test_a_campaign_says_before_it_starts_how_long_it_takes_about(due, episodes, workers, told):
    spec = RunSpec.load(None, [f'training.episodes={episodes}'])
    assert spec.task.time_limit_steps == 600
    assert SECONDS_PER_STEP == 0.0037
    assert told in forecast([spec] * due, workers)


def test_what_was_not_measured_is_not_foretold():
    small = RunSpec.from_mapping({'actor': {'hidden': [8, 8]}}, 'test')
    later = '4 runs of 9 episodes to train; the first episodes will tell how long that takes'
    for workers, odd in ((2, small), (0, RunSpec.load())):
        specs = [spec.with_value('training.episodes', 9, 'test') for spec in (odd, RunSpec.load())]
        assert forecast([*specs, *specs], workers) == later


def test_the_time_of_rows_that_differ_is_added_up():
    short, long = (RunSpec.load(None, [f'task.time_limit_steps={n}']) for n in (600, 1800))
    assert 'about 98 h' in forecast([short] * 160 + [long] * 53, 2)
