# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The ends of an episode of the line task: its time limit, failures and a diverged simulation."""

import math
from pathlib import Path

import mujoco
import numpy as np
import pytest
from hexapod_sim.sensor_table import MEASURED
from hexapod_sim.sensors import read
from hexapod_sim.task import LineTask, failure_cause
from hexapod_sim.task_config import TaskConfig

from hexapod_sim import robot

NEUTRAL = np.tile(robot.NEUTRAL_POSE, (robot.SUBSTEPS, 1))
CONFIG = TaskConfig.of_article()


@pytest.fixture
def task() -> LineTask:
    return LineTask(TaskConfig.of_article())


def test_standing_still_lasts_to_the_time_limit() -> None:
    task = LineTask(TaskConfig.of_article(time_limit_steps=20))
    task.reset(0)
    outcomes = [task.advance(NEUTRAL) for _ in range(20)]
    assert not any(outcome.truncated or outcome.terminated for outcome in outcomes[:-1])
    assert outcomes[-1].truncated
    assert not outcomes[-1].terminated
    assert outcomes[-1].cause == 'time_limit'
    with pytest.raises(RuntimeError, match=r'expected reset\(\) before advance'):
        task.advance(NEUTRAL)


@pytest.mark.parametrize(
    ('state', 'cause'),
    [
        ((0.0, 0.0, 0.13, 0.0), ''),
        ((1.1, 0.0, 0.13, 0.0), 'flipped'),
        ((0.0, -1.1, 0.13, 0.0), 'flipped'),
        ((0.0, 0.0, 0.04, 0.0), 'collapsed'),
        ((0.0, 0.0, 0.13, -2.1), 'strayed'),
        ((0.0, 0.0, 0.13, 2.1), 'strayed'),
        ((0.9, 0.9, 0.06, 1.9), ''),
    ],
)
def test_failure_causes(state: tuple[float, float, float, float], cause: str) -> None:
    assert failure_cause(*state, CONFIG) == cause


@pytest.mark.parametrize(
    ('pose', 'cause'),
    [
        ([0, 0, 0.3, math.cos(0.8), math.sin(0.8), 0, 0], 'flipped'),
        ([0, 0, 0.3, math.cos(0.8), 0, math.sin(0.8), 0], 'flipped'),
        ([0, -2.3, 0.13, 1, 0, 0, 0], 'strayed'),
    ],
)
def test_failure_terminates_the_episode(task: LineTask, pose: list[float], cause: str) -> None:
    task.reset(0)
    task.simulation.data.qpos[:7] = pose
    mujoco.mj_forward(task.simulation.model, task.simulation.data)
    outcome = task.advance(NEUTRAL)
    assert (outcome.terminated, outcome.truncated, outcome.cause) == (True, False, cause)
    with pytest.raises(RuntimeError, match='no episode runs'):
        task.advance(NEUTRAL)


def test_folding_the_legs_up_collapses_the_robot(task: LineTask) -> None:
    task.reset(0)
    folded = NEUTRAL.copy()
    folded[:, 1::3] = robot.LEG_UPPER[1]
    outcome = task.advance(folded)
    while not outcome.terminated:
        outcome = task.advance(folded)
    assert outcome.cause == 'collapsed'


def test_failure_at_the_time_limit_is_a_failure() -> None:
    task = LineTask(TaskConfig.of_article(time_limit_steps=1, max_offset=0.0))
    task.reset(0)
    outcome = task.advance(NEUTRAL)
    assert (outcome.terminated, outcome.truncated, outcome.cause) == (True, False, 'strayed')


def test_divergence_terminates_with_readings_that_can_be_used(
    task: LineTask, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)  # MuJoCo leaves its log of warnings where it runs
    task.reset(4)
    offset = task.line_offset
    task.simulation.data.qvel[0] = math.nan
    mujoco.mj_forward(task.simulation.model, task.simulation.data)
    outcome = task.advance(NEUTRAL)
    assert (outcome.terminated, outcome.cause, outcome.reward) == (True, 'diverged', 0.0)
    assert sum(outcome.terms.values()) == 0.0
    assert task.line_offset == offset
    for channel, value in read(task.simulation, MEASURED).items():
        assert np.isfinite(value).all(), channel
