# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The evaluation of a varied robot tells whether it recovers; that of a sound one is as before."""

import numpy as np
import pytest
from hexapod_agent.environment.env import HexapodLine
from hexapod_agent.learning.evaluator import Evaluator
from hexapod_agent.learning.metrics import LATE_SPEED, RECOVERED
from hexapod_agent.train import evaluate
from hexapod_sim.recovery import has_recovered
from hexapod_sim.task import Outcome

DEAD = {'robot': {'dead_legs': 'lf+rm', 'fault_time': 0.25}, 'training': {'evaluation': 3}}


def play(evaluator: Evaluator, speeds: list[float], fell: bool = False):
    """Play an episode whose control periods have these speeds, m/s."""
    task = evaluator.config.task
    evaluator.begin_episode(evaluator.start)
    seen = np.zeros(1, np.float32)
    evaluator.observe(seen, Outcome(0, 0.0, {'velocity': 0.0}, False, False, ''))
    for step, speed in enumerate(speeds, 1):
        terms = {'velocity': task.velocity_weight * speed / task.velocity_scale}
        last = step == len(speeds)
        outcome = Outcome(step, 1.0, terms, fell and last, last and not fell, '')
        if not last:
            evaluator.observe(seen, outcome)
    return evaluator.end_episode(seen, outcome)


def new(config) -> Evaluator:
    return Evaluator(lambda observation: np.zeros(30, np.float32), config)


def test_a_sound_robot_is_evaluated_as_ever(small_config):
    evaluator = new(small_config.with_value('training.evaluation', 2, 'a test'))
    for start in range(2):
        assert (evaluator.start, evaluator.is_reported, evaluator.is_done) == (start, True, False)
        assert np.isnan(play(evaluator, [0.2, 0.2]).metrics[RECOVERED])
    assert evaluator.is_done


def test_the_undamaged_robot_comes_first_and_is_not_reported(small_config):
    varied = small_config.changed(DEAD, 'a test')
    evaluator = new(varied)
    assert evaluator.config.robot == small_config.robot
    for start in range(3):
        assert (evaluator.start, evaluator.is_reported) == (start, False)
        play(evaluator, [0.0] * 280 + [0.1 + 0.1 * start] * 320)  # of 8 s: 0.2 m/s in the mean
    assert evaluator.config == varied
    found = [
        play(evaluator, [0.3] * 280 + [0.1] * 320).metrics,
        play(evaluator, [0.3] * 280 + [0.09] * 320).metrics,
        play(evaluator, [0.3] * 600, fell=True).metrics,
    ]
    assert [each[LATE_SPEED] for each in found] == pytest.approx([0.1, 0.09, 0.3])
    assert [each[RECOVERED] for each in found] == [1.0, 0.0, 0.0]
    assert evaluator.is_done
    assert evaluator.summary.average_return == pytest.approx(600.0)  # not of those before


def test_half_the_speed_and_no_fall_is_recovered():
    assert has_recovered(False, 0.1, 0.2)
    assert not has_recovered(False, 0.099, 0.2)
    assert not has_recovered(True, 0.3, 0.2)


def test_the_evaluation_of_a_training_reports_who_recovers(make_trainer, small_config):
    config = small_config.changed(DEAD, 'a test')
    summaries = list(evaluate(HexapodLine(config=config), make_trainer('', config=config)))
    assert [summary.episode for summary in summaries] == [0, 1, 2]
    assert {summary.metrics[RECOVERED] for summary in summaries} <= {0.0, 1.0}
    assert all(np.isfinite(summary.metrics[LATE_SPEED]) for summary in summaries)
