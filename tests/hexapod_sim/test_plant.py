# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The plant in real time: it plays what came last, holds still without, and never ends."""

from __future__ import annotations

import numpy as np
import pytest
from hexapod_sim.plant import Plant
from hexapod_sim.task import LineTask
from hexapod_sim.task_config import TaskConfig

from hexapod_sim import robot

STANDING = np.tile(robot.NEUTRAL_POSE, (robot.SUBSTEPS, 1))


@pytest.fixture
def task() -> LineTask:
    return LineTask(TaskConfig.of_article())


def test_each_trajectory_is_played_once_and_its_last_target_is_held(task: LineTask) -> None:
    played: list[np.ndarray] = []
    simulate = task.simulation.advance
    task.simulation.advance = lambda targets: (played.append(targets), simulate(targets))[1]
    plant = Plant(task)
    plant.reset(1, TaskConfig.of_article())
    way = STANDING + np.linspace(0.0, 0.1, robot.SUBSTEPS)[:, None]
    plant.advance()
    plant.play(way)
    plant.advance()
    plant.play(way)  # the newest one is still the same
    plant.advance()
    np.testing.assert_array_equal(played[0], STANDING)
    np.testing.assert_array_equal(played[1], way)
    np.testing.assert_array_equal(played[2], np.tile(way[-1], (robot.SUBSTEPS, 1)))


def test_it_equals_the_task_as_long_as_both_go_on(task: LineTask) -> None:
    alone = LineTask(TaskConfig.of_article())
    plant = Plant(task)
    assert plant.reset(4, TaskConfig.of_article()) == alone.reset(4)
    for step in range(20):
        targets = STANDING + 0.005 * step
        plant.play(targets)
        assert plant.advance() == alone.advance(targets)


def test_no_episode_ends_by_time(task: LineTask) -> None:
    plant = Plant(task)
    plant.reset(1, TaskConfig.of_article(time_limit_steps=3))
    outcomes = [plant.advance() for _ in range(6)]
    assert [outcome.step for outcome in outcomes] == [1, 2, 3, 4, 5, 6]
    assert not any(outcome.truncated for outcome in outcomes)


def test_physics_goes_on_after_a_failure(task: LineTask) -> None:
    plant = Plant(task)
    plant.reset(1, TaskConfig.of_article(max_offset=0.001))
    failed = plant.advance()
    assert (failed.terminated, failed.cause) == (True, 'strayed')
    before = task.simulation.data.time
    assert plant.advance() == failed
    assert task.simulation.data.time == pytest.approx(before + 0.025)
    assert plant.reset(1, TaskConfig.of_article()).step == 0
    assert not plant.advance().terminated


def test_it_must_be_put_somewhere_first(task: LineTask) -> None:
    with pytest.raises(RuntimeError, match='reset'):
        Plant(task).advance()
