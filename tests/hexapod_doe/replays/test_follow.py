# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Step responses whose figures are known in closed form, and the report of a bag."""

import math

import numpy as np
import pytest
from hexapod_doe.bags.bag_writer import BagWriter
from hexapod_doe.bags.rosbag2 import Topic
from hexapod_doe.errors import BagError
from hexapod_doe.follow_report import main
from hexapod_doe.replays.follow import Track, read_track, responses, step_response

PERIOD_S = 0.025
TIME = np.arange(601) * PERIOD_S


def test_exponential_approach_settles_after_its_logarithm():
    # offset = -exp(-t): below 0.1 from ln 10 = 2.3026 s on, so from the sample at 2.325 s.
    response = step_response(TIME + 7.0, -np.exp(-TIME), 1.0)
    assert response.time == 7.0
    assert response.settling_time == pytest.approx(2.325)
    assert response.overshoot == 0.0
    assert response.offset_after == pytest.approx(math.exp(-10.0))


@pytest.mark.parametrize('side', [1.0, -1.0])
def test_overshoot_of_a_second_order_system(side):
    # x'' + 2 z x' + x = 1 with z = 0.5 overshoots by exp(-pi z / sqrt(1 - z^2)) = 16.3 %.
    damping, frequency = 0.5, math.sqrt(0.75)
    decay = np.exp(-damping * TIME)
    wave = np.cos(frequency * TIME) + damping / frequency * np.sin(frequency * TIME)
    response = step_response(TIME, -side * decay * wave, side)
    assert response.jump == side
    assert response.overshoot == pytest.approx(math.exp(-math.pi / math.sqrt(3.0)), abs=1e-4)


def test_a_robot_that_stays_away_never_settles():
    response = step_response(TIME, np.full(TIME.size, -0.5), 1.0)
    assert math.isnan(response.settling_time)
    assert response.offset_after == 0.5


def test_a_robot_that_is_there_has_settled_at_once():
    assert step_response(TIME, np.zeros(TIME.size), 0.05).settling_time == 0.0


def test_a_short_interval_has_no_offset_after():
    assert math.isnan(step_response(TIME[:100], np.zeros(100), 1.0).offset_after)


def test_each_jump_is_measured_until_the_next():
    line = np.repeat([-0.5, 0.5, -0.5], 200)
    time = np.arange(600) * PERIOD_S
    found = responses(Track(time, time, np.zeros(600), line))
    assert [(r.time, r.jump) for r in found] == [(5.0, 1.0), (10.0, -1.0)]


def test_a_jump_in_the_last_sample_is_none_and_spoils_none():
    line = np.array([0.0, 1.0, 1.0, 0.0])
    (response,) = responses(Track(np.arange(4.0), np.zeros(4), np.full(4, 0.9), line))
    assert (response.time, response.jump, response.overshoot) == (1.0, 1.0, 0.0)


def topics(namespace='/w'):
    return (
        Topic(f'{namespace}/odom', 'nav_msgs/msg/Odometry'),
        Topic(f'{namespace}/line_offset', 'hexapod_interfaces/msg/LineOffset'),
    )


@pytest.fixture
def write(tmp_path):
    """Write a bag of a robot that approaches a line exponentially after each jump."""

    def write_bag(lines, drop_last=False, spec=''):
        from hexapod_interfaces.msg import LineOffset
        from nav_msgs.msg import Odometry
        from rclpy.serialization import serialize_message

        bag = tmp_path / 'follow'
        odom, offsets = topics()
        with BagWriter(bag, {'run_id': 'follow', 'spec': spec}) as writer:
            writer.add_topic(odom)
            writer.add_topic(offsets)
            y = lines[0]
            for step, line in enumerate(lines):
                stamp = 1_000_000_000 + step * 25_000_000
                y = line + (y - line) * math.exp(-PERIOD_S)
                position = Odometry()
                position.pose.pose.position.x = 0.2 * step * PERIOD_S
                position.pose.pose.position.y = y
                offset = LineOffset(offset=y - line)
                for topic, message in ((odom, position), (offsets, offset)):
                    if drop_last and topic is offsets and step == len(lines) - 1:
                        continue
                    seconds, nanoseconds = divmod(stamp, 1_000_000_000)
                    message.header.stamp.sec, message.header.stamp.nanosec = seconds, nanoseconds
                    writer.write(topic.name, serialize_message(message), stamp)
        return bag

    return write_bag


def test_report_of_a_bag(write, capsys):
    bag = write(np.repeat([-0.5, 0.5, -0.5], 600))
    track = read_track(bag)
    assert track.time[-1] == pytest.approx(1799 * PERIOD_S)
    assert track.x[-1] == pytest.approx(0.2 * track.time[-1])
    main([str(bag)])
    printed = capsys.readouterr().out
    assert '+1.00' in printed
    assert '-1.00' in printed
    assert '2.30' in printed  # ln 10; the jump's own sample has moved already
    assert bag.with_name('follow.png').read_bytes().startswith(b'\x89PNG')


def test_a_line_that_stays_is_refused(write, capsys):
    bag = write(np.zeros(10))
    with pytest.raises(SystemExit):
        main([str(bag)])
    assert 'the line stays, expected one that jumps' in capsys.readouterr().err


def test_a_lost_sample_is_told(write):
    bag = write(np.zeros(10), drop_last=True)
    with pytest.raises(BagError, match='10 samples of odom and 9 of line_offset'):
        read_track(bag)


def test_a_bad_line_sensor_is_refused(write):
    bag = write(np.zeros(10), spec='sensors: {line_offset: {noise: 0.01}}')
    with pytest.raises(BagError, match=r'line_offset has the errors of its sensors\.line'):
        read_track(bag)
