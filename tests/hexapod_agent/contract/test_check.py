# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A healthy robot passes, and each single fault is named with its field and its cure."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
from hexapod_agent.contract.evidence import Offer, Sample
from hexapod_agent.contract.limits import Limits
from hexapod_sim.robot import JOINTS
from hexapod_sim.sensor_table import CHANNELS, LETTERS


def test_a_healthy_robot_passes_without_a_word(robot) -> None:
    report = robot.report()
    assert report.findings == ()
    assert report.passed
    expected = [channel.letter for channel in CHANNELS for _ in channel.topics]
    assert expected[:15] == [*['', '', ''], *'ABCDE', *'FFFFFF', 'G']
    assert [row.letter for row in report.rows] == expected
    for row in report.rows:
        assert row.rate == pytest.approx(40.0)
        assert row.lag == pytest.approx(0.0)
        assert row.verdict == 'pass'


def test_the_report_is_plain_json(robot) -> None:
    robot.each('imu/data', lambda sample: replace(sample, frame='bno055'))
    read = json.loads(json.dumps(robot.report().as_dict()))
    assert read['passed'] is False
    assert read['observations'] == LETTERS
    assert [finding['kind'] for finding in read['findings']] == ['wrong_frame']
    verdicts = {row['topic']: row['verdict'] for row in read['topics']}
    assert verdicts.pop('/robot/imu/data') == 'fault'
    assert set(verdicts.values()) == {'pass'}


def test_only_the_channels_of_the_set_are_checked(robot) -> None:
    robot.change('imu/data', lambda had: replace(had, offers=(), samples=()))
    assert robot.report(letters='ABDEFG').passed
    assert not robot.report(letters='C').passed


def named(finding, kind: str, field: str, *words: str) -> None:
    """Hold a finding to its kind and field, and to words of what is found and of the cure."""
    assert (finding.kind, finding.field) == (kind, field)
    for word in words:
        assert word in str(finding), str(finding)


@pytest.mark.parametrize('topic', ['joint_states', 'imu/data', 'foot_force/lm', 'foot_contacts'])
def test_a_missing_publisher_is_named(robot, topic: str) -> None:
    robot.change(topic, lambda had: replace(had, offers=(), samples=()))
    named(robot.fault(), 'missing', 'topic', f'/robot/{topic}', 'remap')


def test_a_silent_driver_is_named(robot) -> None:
    robot.change('body/height', lambda had: replace(had, samples=()))
    named(robot.fault(), 'stopped', 'topic', 'body height', 'brought no message', 'powered')


def test_a_driver_that_stopped_is_named(robot) -> None:
    robot.change('imu/data', lambda had: replace(had, samples=had.samples[:40]))
    named(robot.fault(), 'stopped', 'topic', 'is silent since 1.02 s', 'powered')


def test_another_type_is_named(robot) -> None:
    offer = Offer('/lidar', 'sensor_msgs/msg/LaserScan')
    robot.change('body/height', lambda had: replace(had, offers=(offer,), samples=()))
    named(robot.fault(), 'wrong_type', 'topic', 'LaserScan', 'publish sensor_msgs/msg/Range')


def test_two_publishers_on_one_topic_are_named(robot) -> None:
    offers = (Offer('/sim', 'sensor_msgs/msg/Imu'), Offer('/bno055', 'sensor_msgs/msg/Imu'))
    robot.change('imu/data', lambda had: replace(had, offers=offers))
    named(robot.fault(), 'many_publishers', 'topic', '/sim, /bno055', 'stop all of them but one')


def test_what_two_publishers_say_by_turns_is_no_further_fault(robot) -> None:
    """The frame of the second driver must not be accepted: the driver must go."""
    offers = (Offer('/sim', 'sensor_msgs/msg/Imu'), Offer('/bno055', 'sensor_msgs/msg/Imu'))
    robot.change('imu/data', lambda had: replace(had, offers=offers))
    robot.each('imu/data', lambda sample: replace(sample, frame='bno055', stamp_ns=0))
    named(robot.fault(), 'many_publishers', 'topic')


def test_best_effort_suits_realtime_and_not_lock_step(robot) -> None:
    offer = Offer('/bno055', 'sensor_msgs/msg/Imu', reliable=False)
    robot.change('imu/data', lambda had: replace(had, offers=(offer,)))
    assert robot.report(reliable=False).passed
    fault = robot.fault(reliable=True)
    named(fault, 'qos_mismatch', 'qos.reliability', 'best effort', 'sync:=realtime')


@pytest.mark.parametrize(
    ('stamp', 'words'),
    [
        (lambda ns: 0, 'is never set'),
        (lambda ns: 7, 'stands still'),
        (lambda ns: 10_000_000_000 - ns, 'jumps back 79 times'),
        (lambda ns: ns - 2_000_000_000, '2.000 s behind the other channels'),
        (lambda ns: ns + 400_000_000, '0.400 s ahead of the other channels'),
    ],
)
def test_stale_stamps_are_named(robot, stamp, words: str) -> None:
    robot.each('imu/data', lambda sample: replace(sample, stamp_ns=stamp(sample.stamp_ns)))
    named(robot.fault(), 'stale_stamps', 'header.stamp', words)


def test_six_load_cells_count_as_one_clock(robot) -> None:
    """A device with six topics does not outvote the three channels that are always there."""
    for leg in ('lf', 'lm', 'lr', 'rf', 'rm', 'rr'):
        robot.each(
            f'foot_force/{leg}',
            lambda sample: replace(sample, stamp_ns=sample.stamp_ns - 1_000_000_000),
        )
    faults = robot.report(letters='F').faults
    assert [fault.channel for fault in faults] == ['foot forces'] * 6


def test_a_slow_driver_is_a_warning_and_a_very_slow_one_a_fault(robot) -> None:
    robot.change('body/height', lambda had: replace(had, samples=had.samples[::2]))
    report = robot.report()
    assert report.passed
    named(report.findings[0], 'slow', 'rate', 'is 20.0 Hz', 'raise')
    robot.change('body/height', lambda had: replace(had, samples=had.samples[::5]))
    named(robot.fault(), 'slow', 'rate', 'is 4.0 Hz', 'not under 10 Hz')
    assert robot.report(Limits(ages={'body/height': 0.3})).passed


def test_a_driver_that_pauses_alone_is_named(robot) -> None:
    robot.change('imu/data', lambda had: replace(had, samples=had.samples[:20] + had.samples[50:]))
    named(robot.fault(), 'pauses', 'rate', 'has 1 pauses of up to 0.78 s', 'bus resets')


def test_a_pause_of_all_channels_is_none_of_a_driver(robot) -> None:
    for topic in robot.evidence.topics:
        robot.change(topic, lambda had: replace(had, samples=had.samples[:20] + had.samples[50:]))
    assert robot.report().findings == ()


def test_a_wrong_frame_is_named_unless_the_user_says_it_is_equal(robot) -> None:
    robot.each('imu/data', lambda sample: replace(sample, frame='bno055'))
    named(robot.fault(), 'wrong_frame', 'header.frame_id', "'bno055'", "'imu_link'")
    assert robot.report(Limits(frames={'imu/data': 'bno055'})).passed


def test_joint_names_in_any_order_pass(robot) -> None:
    order = np.random.default_rng(3).permutation(18)
    names = tuple(f'px/{JOINTS[index]}' for index in order)
    for topic, paths in (
        ('joint_states', ('position', 'velocity')),
        ('joint_torques', ('effort',)),
    ):
        robot.each(topic, lambda sample: replace(sample, names=names))
        for path in paths:
            robot.values(topic, path, lambda values: values[order])
    assert robot.report().findings == ()


def test_wrong_joint_names_are_named(robot) -> None:
    names = ('hip_1', *JOINTS[1:])
    robot.each('joint_states', lambda sample: replace(sample, names=names))
    named(robot.fault(), 'wrong_names', 'name', 'lacks lf_hip', 'URDF')


@pytest.mark.parametrize(
    ('topic', 'path', 'length'),
    [('joint_states', 'velocity', 17), ('joint_torques', 'effort', 0), ('cpg/state', 'x', 5)],
)
def test_a_wrong_length_is_named(robot, topic: str, path: str, length: int) -> None:
    robot.values(topic, path, lambda values: values[:length])
    cure = 'fill' if length else "the state interface 'effort'"
    named(robot.fault(), 'wrong_length', path, f'has {length} numbers', cure)


@pytest.mark.parametrize(
    ('topic', 'path', 'field'),
    [
        ('joint_states', 'velocity', 'velocity[lf_hip]'),
        ('imu/data', 'orientation', 'orientation[0]'),
        ('body/height', 'range', 'range[0]'),
        ('foot_force/rm', 'wrench.force', 'wrench.force[0]'),
    ],
)
@pytest.mark.parametrize('value', [np.nan, np.inf])
def test_numbers_that_are_not_finite_are_named(robot, topic, path, field, value: float) -> None:
    def broken(values: np.ndarray) -> np.ndarray:
        changed = values.copy()
        changed[0] = value
        return changed

    robot.values(topic, path, broken)
    cure = "the state interface 'velocity'" if topic == 'joint_states' else 'measures it at all'
    named(robot.fault(), 'not_finite', field, 'in 80 of 80 messages', cure)


def test_numbers_that_are_missing_now_and_then_are_named(robot) -> None:
    values = iter([np.nan, np.inf] + 78 * [0.0])
    robot.values('imu/data_raw', 'angular_velocity', lambda v: v + next(values))
    named(robot.fault(), 'not_finite', 'angular_velocity[0]', 'in 2 of 80 messages', 'leave out')


def test_one_report_holds_several_faults(robot) -> None:
    def broken(sample: Sample) -> Sample:
        return replace(sample, frame='x', stamp_ns=0)

    robot.each('imu/data_raw', broken)
    robot.values('imu/data_raw', 'linear_acceleration', np.negative)
    kinds = [fault.kind for fault in robot.report().faults]
    assert kinds == ['stale_stamps', 'wrong_frame', 'flipped_gravity']
    assert robot.report().refusal.count('\n') == 2
