# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""An IMU's axes, signs and quaternions, against what REP-103 and REP-145 say."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hexapod_agent.contract.inertial import tilt


@pytest.mark.parametrize('topic', ['imu/data', 'imu/data_raw'])
def test_flipped_gravity_is_named(robot, topic: str) -> None:
    robot.values(topic, 'linear_acceleration', np.negative)
    fault = robot.fault()
    assert (fault.kind, fault.field) == ('flipped_gravity', 'linear_acceleration.z')
    assert 'points to -z at rest' in fault.found
    assert 'negate it' in fault.cure


def test_the_steps_of_a_walking_robot_are_no_other_unit(robot) -> None:
    """Ten samples with a standard deviation of 4 m/s²: their mean is uncertain by 1.3 m/s²."""
    generator = np.random.default_rng(6)
    robot.values('imu/data', 'linear_acceleration', lambda a: a + generator.normal(0, 4.0, 3))
    robot.values('imu/data', 'linear_acceleration', lambda a: a - np.array([0.0, 0.0, 1.6]))
    assert robot.report().passed
    robot.values('imu/data', 'linear_acceleration', lambda a: a - np.array([0.0, 0.0, 2.0]))
    assert robot.fault().kind == 'wrong_unit'


def test_turned_axes_are_named(robot) -> None:
    robot.values('imu/data_raw', 'linear_acceleration', lambda a: np.roll(a, 1))
    fault = robot.fault()
    assert fault.kind == 'wrong_axes'
    assert 'points to +x' in fault.found


def test_an_acceleration_that_is_marked_as_not_given_is_not_judged(robot) -> None:
    robot.values('imu/data', 'linear_acceleration', np.zeros_like)
    assert [finding.kind for finding in robot.report().findings] == ['not_measured']
    robot.values('imu/data', 'linear_acceleration_covariance', lambda c: c - 1.0)
    (note,) = robot.report().findings
    assert (note.kind, note.level) == ('not_measured', 'note')
    assert 'by hand' in note.cure


@pytest.mark.parametrize(
    ('change', 'words'),
    [
        (np.zeros_like, 'norm of 0.000'),
        (lambda q: 1.2 * q, 'norm of 1.200'),
        (lambda q: np.roll(q, 1), 'w x y z'),
        (lambda q: np.array([1.0, 0.0, 0.0, 0.0]), 'tilted by 180 degrees'),
    ],
)
def test_a_bad_quaternion_is_named(robot, change, words: str) -> None:
    robot.values('imu/data', 'orientation', change)
    fault = robot.fault()
    assert (fault.kind, fault.field) == ('bad_quaternion', 'orientation')
    assert words in str(fault)


@pytest.mark.parametrize(
    ('topic', 'field'), [('imu/data', 'orientation'), ('imu/data_raw', 'angular_velocity')]
)
def test_what_is_observed_and_not_measured_is_a_fault(robot, topic: str, field: str) -> None:
    robot.values(topic, f'{field}_covariance', lambda c: c - 1.0)
    robot.values(topic, field, np.zeros_like)
    fault = robot.fault()
    assert (fault.kind, fault.field) == ('not_measured', field)
    assert 'marked as not measured (covariance -1)' in fault.found


def test_what_is_not_measured_and_not_observed_does_not_matter(robot) -> None:
    robot.values('imu/data', 'angular_velocity_covariance', lambda c: c - 1.0)
    robot.values('imu/data_raw', 'orientation_covariance', lambda c: c - 1.0)
    assert robot.report().findings == ()


def test_tilt_is_the_angle_of_a_roll_or_pitch_and_not_of_a_yaw() -> None:
    half = 0.5 * math.radians(40.0)
    turns = np.array(
        [
            [math.sin(half), 0.0, 0.0, math.cos(half)],
            [0.0, math.sin(half), 0.0, math.cos(half)],
            [0.0, 0.0, math.sin(half), math.cos(half)],
        ]
    )
    np.testing.assert_allclose(np.degrees(tilt(turns)), [40.0, 40.0, 0.0], atol=1e-9)
