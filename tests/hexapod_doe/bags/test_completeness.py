# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Each departure of a topic from one sample per period is counted as what it is."""

import pytest
from hexapod_doe.bags.completeness import EpisodeTally, TopicVerdict, describe

PERIOD = 25
SENSOR, COMMAND = 'sensor_msgs/msg/Imu', 'trajectory_msgs/msg/JointTrajectory'


def judge(stamps: list[int], last: int = 100, kind: str = SENSOR, period: int = PERIOD):
    """Return the verdict on one topic beside a whole one, in an episode of stamps 0 to 100."""
    tally = EpisodeTally({'/whole': SENSOR, '/topic': kind}, period)
    for stamp in range(0, 101, 25):
        tally.add('/whole', stamp)
    for stamp in stamps:
        tally.add('/topic', stamp)
    whole, verdict = tally.verdicts(last)
    assert whole == TopicVerdict('/whole', messages=5, due=5)
    return verdict


def test_every_period_once_is_complete():
    assert judge([0, 25, 50, 75, 100]) == TopicVerdict('/topic', messages=5, due=5)


def test_a_command_has_no_sample_at_the_end():
    assert judge([0, 25, 50, 75], kind=COMMAND) == TopicVerdict('/topic', messages=4, due=4)
    assert judge([0, 25, 50], kind=COMMAND).missing == 1


@pytest.mark.parametrize(
    ('stamps', 'fault', 'count'),
    [
        ([0, 25, 75, 100], 'missing', 1),
        ([25, 50, 75, 100], 'missing', 1),
        ([0, 25, 50, 75], 'missing', 1),
        ([], 'missing', 5),
        ([0, 25, 25, 50, 75, 100, 100], 'duplicate', 2),
        ([0, 50, 25, 75, 100], 'out_of_order', 1),
        ([0, 25, 50, 75, 100, 125], 'stray', 1),
        ([0, 25, 50, 60, 75, 100], 'stray', 1),
    ],
)
def test_one_kind_of_fault_is_counted_alone(stamps, fault, count):
    verdict = judge(stamps)
    found = {
        name: getattr(verdict, name) for name in ('missing', 'duplicate', 'out_of_order', 'stray')
    }
    assert {name: n for name, n in found.items() if n} == {fault: count}
    assert not verdict.complete


def test_without_a_grid_nothing_is_due():
    verdict = judge([3, 7, 7], period=PERIOD)
    assert verdict.stray == 2
    tally = EpisodeTally({'/topic': SENSOR}, 0)
    for stamp in (3, 7, 7):
        tally.add('/topic', stamp)
    (verdict,) = tally.verdicts(50)
    assert (verdict.missing, verdict.stray, verdict.duplicate) == (0, 0, 1)
    assert tally.periods(50) == 0


def test_waiting_until_the_last_stamp_of_each_topic():
    tally = EpisodeTally({'/sensor': SENSOR, '/command': COMMAND}, PERIOD)
    assert tally.waiting(50) == ['/sensor', '/command']
    for stamp in (0, 25):
        tally.add('/sensor', stamp)
        tally.add('/command', stamp)
    assert tally.waiting(50) == ['/sensor']
    tally.add('/sensor', 50)
    assert tally.waiting(50) == []
    assert tally.periods(50) == 2


def test_description_names_episode_topic_and_numbers():
    good = judge([0, 25, 50, 75, 100])
    bad = judge([0, 25, 25, 100])
    assert describe(3, [good, bad]) == [
        'episode 3, /topic: 4 of 5, 2 missing from 0.000 s, 1 duplicate'
    ]


@pytest.mark.parametrize('wrong', [0, 2**31 - 1])
def test_a_stamp_of_any_time_is_told_and_costs_no_memory(wrong):
    second = 10**9
    period = 25_000_000
    tally = EpisodeTally({'/imu': SENSOR}, period)
    stamps = [1000 * second + period * k for k in range(5)]
    for stamp in [*stamps, wrong * second]:
        tally.add('/imu', stamp)
    (verdict,) = tally.verdicts(stamps[-1])
    assert verdict.messages == 6
    assert (verdict.missing > 10_000) if wrong == 0 else (verdict.stray == 1)
    (verdict,) = tally.verdicts((2**31 - 1) * second)
    assert verdict.missing > 10**10
