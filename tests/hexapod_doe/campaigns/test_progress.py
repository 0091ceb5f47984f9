# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import math

import pytest
from hexapod_doe.campaigns.overview import measured
from hexapod_doe.campaigns.progress import Progress, Run, State, duration


def made(*runs: Run) -> Progress:
    return Progress('c', {run.run_id: run for run in runs})


DONE = Run('a', '', State.DONE, '/w1', 10, [0.0] * 10, seconds=20.0)
RUNNING = Run('b', '', State.RUNNING, '/w2', 10, [0.0] * 4, seconds=2.0)
DUE = Run('c', '')


def test_the_time_left_is_what_is_open_at_the_present_rate():
    progress = made(DONE, RUNNING, DUE)
    assert progress.episodes == 14
    assert progress.planned == 30
    assert progress.episodes_per_second == pytest.approx(2.0)
    # 6 of the running row and 10 of the due one, at 2 a second.
    assert progress.seconds_left == pytest.approx(8.0)


def test_nothing_is_known_of_a_time_left_that_nobody_works_off():
    assert math.isnan(made(DONE, DUE).seconds_left)
    assert math.isnan(made(DUE).seconds_left)


def test_finished_runs_tell_how_many_a_core_does_in_an_hour():
    resumed = Run('e', '', State.DONE, '/w2', 10, [0.0] * 10, seconds=10.0, earlier=5)
    # One run in 20 s and half a run in 10 s: 1.5 in 30 s.
    assert made(DONE, resumed).runs_per_core_hour == pytest.approx(180.0)
    # Six tenths of the run under way, and one that is due.
    assert made(DONE, RUNNING, DUE).core_hours_left == pytest.approx(1.6 * 20.0 / 3600.0)
    assert math.isnan(made(RUNNING).runs_per_core_hour)
    assert made(DONE).core_hours_left == 0.0


def test_a_line_says_what_finished_runs_took_and_how_long_the_others_will():
    hour = Run('a', '', State.DONE, '/w1', 10, [0.0] * 10, seconds=1800.0)
    line = '1 runs measured: 2.0 per core-hour'
    assert measured(made(hour)) == [line]
    assert measured(made(hour, DUE)) == [f'{line}; 0.5 core-hours left']
    under_way = [Run(name, '', State.RUNNING, f'/{name}', 10) for name in 'bc']
    left = '1.0 core-hours left, 0.5 h with 2 at a time'
    assert measured(made(hour, *under_way)) == [f'{line}; {left}']
    assert measured(made(DUE)) == []


def test_the_rate_is_a_real_number_also_where_it_is_nought():
    assert isinstance(made(DUE).episodes_per_second, float)


def test_nothing_is_left_of_what_is_done_or_failed():
    failed = Run('d', '', State.FAILED, planned=10)
    assert made(DONE, failed).seconds_left == 0.0


def test_the_rate_of_a_resumed_run_leaves_out_what_it_had_before():
    run = Run('b', '', State.RUNNING, '/w', 10, [0.0] * 6, seconds=2.0, earlier=4)
    assert run.episodes_per_second == pytest.approx(1.0)


def test_a_worker_keeps_its_rate_until_its_next_run_has_an_episode():
    fresh = Run('b', '', State.RUNNING, '/w1', 10)
    (worker,) = made(DONE, fresh).workers
    assert worker.runs == (fresh,)
    assert worker.done == 1
    assert worker.episodes_per_second == pytest.approx(0.5)


def test_a_run_without_an_episode_yet_has_the_usual_rate():
    # Its bag tells the worker with its first result.
    fresh = [Run(name, '', State.RUNNING) for name in ('b', 'c')]
    assert made(DONE, *fresh).episodes_per_second == pytest.approx(1.0)
    assert made(*fresh).episodes_per_second == 0.0


def test_the_runs_of_a_fleet_add_up():
    runs = [Run(f'f{k}', '', State.RUNNING, '/fleet', 9, [0.0] * k, seconds=2.0) for k in (1, 3)]
    assert made(*runs).episodes_per_second == pytest.approx(2.0)


@pytest.mark.parametrize(
    ('seconds', 'text'), [(0.4, '0:00'), (61.0, '1:01'), (3725.0, '1:02:05'), (math.nan, '?')]
)
def test_durations(seconds, text):
    assert duration(seconds) == text
