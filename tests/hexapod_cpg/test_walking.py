# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Pattern generator and physics together: the constant gait walks, and can be steered."""

import numpy as np
import pytest
from hexapod_cpg.cpg import Cpg
from hexapod_cpg.mapping import ACTION_SIZE, READINGS, ActionRanges, command_from_action
from hexapod_cpg.oscillator import HopfConfig
from hexapod_sim.sensors import read
from hexapod_sim.task import LineTask
from hexapod_sim.task_config import TaskConfig

from hexapod_sim import robot

RANGES = ActionRanges.of_article()

PERIOD_S = robot.CONTROL_PERIOD_NS * 1e-9
HIP_GAIN = READINGS['D1'].index('hip_gain')
ON_THE_LINE = TaskConfig.of_article(start_offset=0.0, max_offset=10.0)


def walk(actions: np.ndarray, reading: str = 'D1') -> np.ndarray:
    """Poses (periods, 6) under actions (periods, 30); every period must be without a fall."""
    task, cpg = LineTask(ON_THE_LINE), Cpg(HopfConfig.of_article())
    task.reset(0)
    poses = []
    for action in actions:
        outcome = task.advance(cpg.advance(command_from_action(action, reading, RANGES)))
        assert not outcome.terminated, outcome.cause
        poses.append(task.simulation.pose())
    return np.array(poses)


def steer(left: float, right: float) -> np.ndarray:
    """A constant action with other hip gains on the left than on the right."""
    action = np.zeros((6, 5))
    action[:3, HIP_GAIN], action[3:, HIP_GAIN] = left, right
    return np.tile(action.ravel(), (400, 1))


def turn_rate(poses: np.ndarray) -> float:
    """Mean yaw rate [rad/s] after the first two seconds."""
    yaw = np.unwrap(poses[80:, 5])
    return float((yaw[-1] - yaw[0]) / ((len(yaw) - 1) * PERIOD_S))


@pytest.fixture(scope='module')
def constant_gait() -> np.ndarray:
    return walk(np.zeros((600, ACTION_SIZE)))


def test_constant_gait_walks_fast_enough(constant_gait: np.ndarray) -> None:
    speed = (constant_gait[-1, 0] - constant_gait[79, 0]) / (520 * PERIOD_S)
    assert 0.22 < speed < 0.30  # measured: 0.253 m/s


def test_constant_gait_walks_straight(constant_gait: np.ndarray) -> None:
    # 15 s and 3.7 m: measured 0.014 m of drift and 0.012 rad of heading.
    assert abs(constant_gait[-1, 1]) < 0.08
    assert np.abs(constant_gait[:, 5]).max() < 0.08


def test_constant_gait_is_level(constant_gait: np.ndarray) -> None:
    assert np.abs(constant_gait[:, 3:5]).max() < 0.06


def test_walking_height_is_that_of_the_task(constant_gait: np.ndarray) -> None:
    height = constant_gait[80:, 2]
    assert height.mean() == pytest.approx(TaskConfig.of_article().walking_height, abs=0.001)
    assert np.ptp(height) < 0.02


@pytest.mark.parametrize('side', [-1, 1])
def test_hip_gains_apart_turn_the_robot(side: int) -> None:
    # Longer strides on the right turn to the left; measured 0.65 rad/s at the full range.
    rate = turn_rate(walk(steer(-side, side)))
    assert 0.38 < side * rate < 1.0


def test_small_differences_turn_in_proportion() -> None:
    # Measured 0.137 rad/s at a fifth of the range: steering is smooth, not a switch.
    assert turn_rate(walk(steer(-0.2, 0.2))) == pytest.approx(0.13, abs=0.05)


def test_reading_d2_walks_the_same_constant_gait(constant_gait: np.ndarray) -> None:
    np.testing.assert_array_equal(walk(np.zeros((100, ACTION_SIZE)), 'D2'), constant_gait[:100])


@pytest.mark.parametrize('reading', READINGS)
@pytest.mark.parametrize('seed', range(3))
def test_no_action_in_the_ranges_topples_the_robot(reading: str, seed: int) -> None:
    # Extreme actions, held for a random while: between one period and a cycle of the gait.
    rng = np.random.default_rng(seed)
    hold = int(rng.integers(1, 25))
    extremes = rng.choice([-1.0, 1.0], (300 // hold + 1, ACTION_SIZE))
    poses = walk(np.repeat(extremes, hold, axis=0)[:300], reading)
    assert np.abs(poses[:, 3:5]).max() < 0.5


def test_feet_of_the_swinging_tripod_leave_the_floor() -> None:
    task, cpg = LineTask(ON_THE_LINE), Cpg(HopfConfig.of_article())
    task.reset(0)
    gait = command_from_action(np.zeros(ACTION_SIZE), 'D1', RANGES)
    touching = {'swing': [], 'stance': []}
    for period in range(200):
        task.advance(cpg.advance(gait))
        contacts = read(task.simulation, ['foot_contacts'])['foot_contacts']
        if period > 40:
            touching['swing'].extend(contacts[cpg.y < -0.4])
            touching['stance'].extend(contacts[cpg.y > 0.4])
    assert np.mean(touching['swing']) == 0.0
    # Three feet carry the robot; on stiff legs one of them lifts off now and then.
    assert np.mean(touching['stance']) > 0.75
