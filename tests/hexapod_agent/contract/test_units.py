# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Numbers in another unit are recognised, with the factor that cures them."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hexapod_sim.robot import LEGS
from hexapod_sim.sensor_table import CHANNELS
from hexapod_sim.units import OTHER_UNITS

DEGREES = 180.0 / math.pi


@pytest.mark.parametrize(
    ('topic', 'path', 'factor', 'unit'),
    [
        ('joint_states', 'position', DEGREES, 'degrees'),
        ('joint_torques', 'effort', 1000.0, 'N·mm'),
        ('joint_torques', 'effort', 10.2, 'kgf·cm'),
        ('body/twist', 'twist.linear', 1000.0, 'mm/s'),
        ('body/twist', 'twist.linear', 100.0, 'cm/s'),
        ('imu/data_raw', 'angular_velocity', DEGREES, 'degrees/s'),
        ('body/height', 'range', 1000.0, 'mm'),
        ('body/height', 'range', 100.0, 'cm'),
        ('imu/data', 'linear_acceleration', 1 / 9.80665, 'g'),
        ('imu/data', 'linear_acceleration', 100.0, 'cm/s²'),
    ],
)
def test_another_unit_is_named_with_its_cure(robot, topic, path, factor, unit) -> None:
    robot.values(topic, path, lambda values: values * factor)
    if topic == 'body/height':
        for limit in ('min_range', 'max_range'):
            robot.values(topic, limit, lambda values: values * factor)
    fault = robot.fault()
    assert (fault.kind, fault.field) == ('wrong_unit', path)
    assert f'which looks like {unit}' in fault.found
    assert 'divide by' in fault.cure


@pytest.mark.parametrize('factor', [0.101972, 101.972])
def test_the_weight_on_the_feet_tells_the_unit_of_the_forces(robot, factor: float) -> None:
    for leg in LEGS:
        robot.values(f'foot_force/{leg}', 'wrench.force', lambda values: values * factor)
    assert {fault.kind for fault in robot.report().faults} == {'wrong_unit'}
    assert 'gf' in robot.report().refusal


def test_velocities_are_held_against_the_change_of_the_angles(robot) -> None:
    robot.values('joint_states', 'velocity', lambda values: values * 30.0 / math.pi)
    fault = robot.fault()
    assert (fault.kind, fault.field) == ('wrong_unit', 'velocity')
    assert 'rpm' in fault.found


def test_velocities_of_the_wrong_sign_are_named(robot) -> None:
    robot.values('joint_states', 'velocity', np.negative)
    fault = robot.fault()
    assert (fault.kind, fault.field) == ('wrong_sign', 'velocity')
    assert 'negate' in fault.cure


def test_noise_is_no_other_unit(robot) -> None:
    generator = np.random.default_rng(11)
    robot.values('joint_states', 'position', lambda v: v + generator.normal(0.0, 0.02, 18))
    robot.values('joint_states', 'velocity', lambda v: v + generator.normal(0.0, 0.2, 18))
    assert robot.report().faults == ()


def test_numbers_beyond_the_scale_are_a_warning(robot) -> None:
    robot.values('body/twist', 'twist.linear', lambda values: values * 3.0)
    report = robot.report()
    assert report.passed
    (warning,) = report.findings
    assert (warning.kind, warning.level) == ('clipped', 'warning')
    assert 'for 33 % of the numbers, expected ±0.5 m/s' in str(warning)


def test_a_standing_robot_passes_and_says_what_cannot_be_seen(robot) -> None:
    robot.values('joint_states', 'velocity', np.zeros_like)
    robot.values('body/twist', 'twist.linear', np.zeros_like)
    report = robot.report()
    assert report.passed
    assert {finding.kind for finding in report.findings} == {'at_rest'}
    assert {finding.level for finding in report.findings} == {'note'}


def test_every_unit_of_the_table_has_others_to_be_taken_for() -> None:
    observed = {q.unit for channel in CHANNELS if channel.topics for q in channel.quantities}
    assert observed <= set(OTHER_UNITS)
