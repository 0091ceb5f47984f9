# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

from pathlib import Path

import pytest
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_doe.campaigns.forecast import SECONDS_PER_STEP, forecast, seconds_of

import hexapod_agent


@pytest.mark.parametrize(
    ('due', 'episodes', 'workers', 'told'),
    [
        # 320 runs x 1000 episodes x 600 steps at 3.7 ms on two cores are 98.7 h.
        (320, 1000, 2, '320 runs of 1000 episodes to train, 2 at a time: about 99 h'),
        (16, 4, 2, 'about 2 min'),  # a third of it the evaluations
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


def test_swift_yaml_is_foretold_with_its_evaluation():
    swift = RunSpec.load(Path(hexapod_agent.__file__).with_name('swift.yaml'))
    # A tenth of a step and an eighth of the rest, 140 episodes; 20 without updates: a tenth.
    steps = 140 * (0.1 + 0.9 / 8) + 20 * 0.1
    assert seconds_of(swift) == pytest.approx(steps * 600 * 0.0037)
    assert 'about 3.1 h' in forecast([swift] * 320, 2)
    longer = swift.with_value('training.evaluation', 40, 'a test')
    assert seconds_of(longer) - seconds_of(swift) == pytest.approx(20 * 0.1 * 600 * 0.0037)


def test_the_time_of_rows_that_differ_is_added_up():
    short, long = (RunSpec.load(None, [f'task.time_limit_steps={n}']) for n in (600, 1800))
    assert 'about 99 h' in forecast([short] * 160 + [long] * 53, 2)
