# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Actions to commands to joint angles, with numbers worked out by hand."""

import math

import numpy as np
import pytest
from hexapod_cpg.mapping import (
    ACTION_SIZE,
    COMMAND_FIELDS,
    READINGS,
    ActionRanges,
    Command,
    action_from_command,
    command_from_action,
    joint_targets,
)

from hexapod_sim import robot

RANGES = ActionRanges.of_article()

OMEGA = 2 * math.pi / 0.6
ONE_LEG = np.array([1.0, -1.0, 0.5, -0.5, 0.2])


def command(**values: float) -> Command:
    """A command with the same values for all legs, zero where not named."""
    return Command(**{name: np.full(6, values.get(name, 0.0)) for name in COMMAND_FIELDS})


def action_of(leg: str, values: np.ndarray) -> np.ndarray:
    """An action that is zero but for one leg."""
    action = np.zeros((6, 5))
    action[robot.LEGS.index(leg)] = values
    return action.ravel()


def test_command_has_the_fields_of_the_message() -> None:
    assert COMMAND_FIELDS == (
        'mu',
        'frequency',
        'hip_gain',
        'knee_gain',
        'knee_bias',
        'ankle_gain',
        'ankle_bias',
    )


def test_action_zero_is_the_constant_gait_in_both_readings() -> None:
    expected = {
        'mu': 1.0,
        'frequency': OMEGA,
        'hip_gain': 0.25,
        'knee_gain': 0.25,
        'knee_bias': 0.0,
        'ankle_gain': 0.0,
        'ankle_bias': 0.0,
    }
    for reading in READINGS:
        zero = command_from_action(np.zeros(ACTION_SIZE), reading, RANGES)
        for name, value in expected.items():
            np.testing.assert_array_equal(getattr(zero, name), np.full(6, value))


def test_golden_command_of_d1() -> None:
    # (k_h, k_k, b_k, k_a, b_a): 0.25 + 0.15, 0.25 - 0.10, 0.5 * 0.10, -0.5 * 0.15, 0.2 * 0.10.
    got = command_from_action(action_of('rm', ONE_LEG), 'D1', RANGES)
    leg = robot.LEGS.index('rm')
    assert got.hip_gain[leg] == pytest.approx(0.40)
    assert got.knee_gain[leg] == pytest.approx(0.15)
    assert got.knee_bias[leg] == pytest.approx(0.05)
    assert got.ankle_gain[leg] == pytest.approx(-0.075)
    assert got.ankle_bias[leg] == pytest.approx(0.02)
    assert got.mu[leg] == 1.0
    assert got.frequency[leg] == OMEGA
    for name in COMMAND_FIELDS:
        others = np.delete(getattr(got, name), leg)
        np.testing.assert_array_equal(others, getattr(ActionRanges.of_article(), name)[0])


def test_golden_command_of_d2() -> None:
    # (mu, omega, k_h, k_k, k_a): 1 + 0.3, OMEGA - 2, 0.25 + 0.5 * 0.15, 0.25 - 0.5 * 0.10,
    # 0.2 * 0.15; the biases stay zero.
    got = command_from_action(action_of('lf', ONE_LEG), 'D2', RANGES)
    assert got.mu[0] == pytest.approx(1.3)
    assert got.frequency[0] == pytest.approx(OMEGA - 2.0)
    assert got.hip_gain[0] == pytest.approx(0.325)
    assert got.knee_gain[0] == pytest.approx(0.20)
    assert got.ankle_gain[0] == pytest.approx(0.03)
    np.testing.assert_array_equal(got.knee_bias, 0)
    np.testing.assert_array_equal(got.ankle_bias, 0)


def test_golden_joint_angles() -> None:
    # x = 0.5, y = -0.8; k_h = 0.4, k_k = 0.15, b_k = 0.05, k_a = -0.075, b_a = 0.02.
    # hip = 0 + s 0.4 * 0.5 = s 0.2; knee = 0.25 + 0.05 + 0.15 * 0.8 = 0.42;
    # ankle = 0 + 0.02 - 0.075 * 0.8 = -0.04.
    values = {
        'hip_gain': 0.4,
        'knee_gain': 0.15,
        'knee_bias': 0.05,
        'ankle_gain': -0.075,
        'ankle_bias': 0.02,
    }
    angles = joint_targets(command(**values), np.full(6, 0.5), np.full(6, -0.8)).reshape(6, 3)
    np.testing.assert_allclose(angles[:3], [[-0.2, 0.42, -0.04]] * 3, atol=1e-15)
    np.testing.assert_allclose(angles[3:], [[0.2, 0.42, -0.04]] * 3, atol=1e-15)


def test_silent_command_is_the_neutral_pose() -> None:
    rng = np.random.default_rng(0)
    angles = joint_targets(command(), *rng.normal(size=(2, 6)))
    np.testing.assert_array_equal(angles, robot.NEUTRAL_POSE)


def test_swing_lifts_the_leg() -> None:
    gait = command_from_action(np.zeros(ACTION_SIZE), 'D1', RANGES)
    swing = joint_targets(gait, np.zeros(6), np.full(6, -1.0))
    stance = joint_targets(gait, np.zeros(6), np.full(6, 1.0))
    assert np.all((swing - stance)[1::3] > 0)


def test_left_and_right_are_mirror_images() -> None:
    # Exchanging the sides' actions and oscillators exchanges the legs; hips change their sign.
    rng = np.random.default_rng(1)
    action = rng.uniform(-1, 1, (6, 5))
    x, y = rng.uniform(-1, 1, (2, 6))
    swap = [3, 4, 5, 0, 1, 2]
    plain = joint_targets(command_from_action(action.ravel(), 'D1', RANGES), x, y).reshape(6, 3)
    mirrored = joint_targets(
        command_from_action(action[swap].ravel(), 'D1', RANGES), x[swap], y[swap]
    )
    np.testing.assert_allclose(
        mirrored.reshape(6, 3), plain[swap] * [-1, 1, 1], rtol=0, atol=1e-15
    )


@pytest.mark.parametrize('reading', READINGS)
def test_whole_range_stays_inside_the_joint_limits(reading: str) -> None:
    # The largest radius of any oscillator: sqrt(1.3) of D2, enlarged by the coupling (6 %).
    radius = math.sqrt(1.3) * 1.06
    rng = np.random.default_rng(2)
    actions = rng.choice([-1.0, 1.0], (500, ACTION_SIZE))
    phase = rng.uniform(0, 2 * math.pi, (500, 6))
    angles = joint_targets(
        command_from_action(actions, reading, RANGES),
        radius * np.cos(phase),
        radius * np.sin(phase),
    )
    assert np.all(angles > robot.JOINT_LOWER)
    assert np.all(angles < robot.JOINT_UPPER)


@pytest.mark.parametrize('reading', READINGS)
def test_batches_repeat_single_actions_to_the_last_bit(reading: str) -> None:
    rng = np.random.default_rng(3)
    actions = rng.uniform(-1, 1, (4, 3, ACTION_SIZE))
    x, y = rng.uniform(-1, 1, (2, 4, 3, 6))
    batch = joint_targets(command_from_action(actions, reading, RANGES), x, y)
    assert batch.shape == (4, 3, 18)
    for index in np.ndindex(4, 3):
        single = command_from_action(actions[index], reading, RANGES)
        np.testing.assert_array_equal(joint_targets(single, x[index], y[index]), batch[index])


def test_float32_actions_are_widened_first() -> None:
    action = np.linspace(-1, 1, ACTION_SIZE, dtype=np.float32)
    narrow, wide = (
        command_from_action(action, 'D1', RANGES),
        command_from_action(action.astype(np.float64), 'D1', RANGES),
    )
    for name in COMMAND_FIELDS:
        assert getattr(narrow, name).dtype == np.float64
        np.testing.assert_array_equal(getattr(narrow, name), getattr(wide, name))


def test_unknown_reading_is_named() -> None:
    with pytest.raises(ValueError, match="action reading 'D3': expected one of D1, D2"):
        command_from_action(np.zeros(ACTION_SIZE), 'D3', RANGES)


@pytest.mark.parametrize('shape', [(29,), (30, 1), ()])
def test_action_of_another_shape_is_refused(shape: tuple[int, ...]) -> None:
    with pytest.raises(ValueError, match=r'action: expected shape \(\.\.\., 30\), got'):
        command_from_action(np.zeros(shape), 'D1', RANGES)


@pytest.mark.parametrize('reading', READINGS)
def test_an_action_comes_back_from_its_command(reading: str) -> None:
    actions = np.random.default_rng(4).uniform(-1, 1, (4, 3, ACTION_SIZE)).astype(np.float32)
    back = action_from_command(command_from_action(actions, reading, RANGES), reading, RANGES)
    assert back.dtype == np.float32
    np.testing.assert_allclose(back, actions, rtol=0, atol=1e-7)


def test_a_field_without_width_comes_back_as_zero() -> None:
    ranges = ActionRanges.of_article(hip_gain=(0.25, 0.0))
    back = action_from_command(command_from_action(np.ones(30), 'D1', ranges), 'D1', ranges)
    np.testing.assert_array_equal(back.reshape(6, 5), np.tile([0, 1, 1, 1, 1], (6, 1)))
