# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Gaps, refusals, full disks and ends in mid-run: each is told, and what was recorded stays."""

import os
import resource
import time

import pytest
from hexapod_doe.bags.run_record import find_bags, read_run
from hexapod_doe.bags.salvage import salvage
from rclpy.parameter import Parameter
from rosbags.highlevel import AnyReader

pytestmark = pytest.mark.graph

PERIOD_NS = 25_000_000


def test_enable_names_the_topic_that_nobody_publishes(worker, tmp_path):
    worker.start(tmp_path / 'r1')
    worker.node.destroy_publisher(worker.publishers['/w0/clock'])
    response = worker.enable(4)
    assert not response.success
    assert response.message == (
        'episode 4: no publisher of /w0/clock within 0.5 s, expected one of each recorded topic'
    )
    assert list(response.topics) == []


def test_missing_duplicate_and_stray_samples_mark_the_run(worker, tmp_path):
    bag = tmp_path / 'r1'
    worker.start(bag)
    worker.enable(0)
    for k in range(21):
        if k == 7:
            worker.sample(k * PERIOD_NS, without=('/w0/joint_states',))
        else:
            worker.sample(k * PERIOD_NS, command=k < 20)
        if k == 9:
            worker.sample(k * PERIOD_NS, without=('/w0/joint_states', '/w0/clock'))
    worker.sample(20 * PERIOD_NS + 1, without=('/w0/joint_states', '/w0/cpg/command'))
    response = worker.disable(0, 20 * PERIOD_NS)
    faults = [
        'episode 0, /w0/joint_states: 20 of 21, 1 missing from 0.175 s',
        'episode 0, /w0/cpg/command: 21 of 20, 1 duplicate',
        'episode 0, /w0/clock: 22 of 21, 1 stray',
    ]
    assert response.message == '; '.join(faults)
    worker.report(0, 20 * PERIOD_NS)
    assert worker.finish(1).success
    assert read_run(bag).metadata['incomplete'].splitlines() == faults


@pytest.mark.alone
def test_last_sample_that_never_comes_is_reported_after_the_time(worker, tmp_path):
    worker.start(tmp_path / 'r1')
    worker.enable(0)
    for k in range(20):
        worker.sample(k * PERIOD_NS)
    began = time.monotonic()
    response = worker.disable(0, 20 * PERIOD_NS)
    assert 0.3 <= time.monotonic() - began < 2.0
    assert '/w0/clock: 20 of 21, 1 missing from 0.500 s' in response.message
    assert '/w0/cpg/command' not in response.message


def test_periods_are_compared_with_the_steps_of_the_result(worker, tmp_path):
    worker.start(tmp_path / 'r1')
    worker.enable(0)
    last_ns = worker.play_episode(0, 20)
    worker.disable(0, last_ns)
    worker.report(0, last_ns, steps=21)
    assert worker.finish(1).success
    assert read_run(tmp_path / 'r1').metadata['incomplete'] == (
        'episode 0: 20 of 21 periods recorded'
    )


def test_short_bag_is_refused_and_keeps_its_unfinished_name(worker, tmp_path):
    bag = tmp_path / 'r1'
    worker.start(bag)
    worker.report(0, 0)
    worker.report(0, 0)
    worker.report(1, 0, run_id='another')
    response = worker.finish(3)
    assert not response.success
    assert response.message == (
        'run r1: 1 of 3 episode results recorded, episode 1 is the first to lack; '
        f'the bag stays {bag}.partial'
    )
    assert find_bags(tmp_path) == []
    assert os.listdir(tmp_path) == ['r1.partial']
    assert list(read_run(salvage(bag)).episodes.index) == [0]


def test_stopping_leaves_a_readable_unfinished_bag(worker, tmp_path):
    worker.start(tmp_path / 'r1')
    worker.report(0, 0)
    assert worker.spin_until(lambda: worker.recorder._recording.results == {0})
    worker.close()
    assert os.listdir(tmp_path) == ['r1.partial']
    with AnyReader([tmp_path / 'r1.partial']) as reader:
        assert reader.message_count == 1


def test_next_run_gives_up_the_open_one_and_leaves_nothing_of_it(worker, tmp_path):
    bag = tmp_path / 'r1'
    for attempt in range(2):
        assert worker.start(bag, attempt=str(attempt)).success
        worker.report(0, 0)
        assert worker.spin_until(lambda: worker.recorder._recording.results == {0})
    assert worker.finish(1).success
    assert os.listdir(tmp_path) == ['r1']
    assert read_run(bag).metadata['attempt'] == '1'


def test_refusals_name_what_was_expected(worker, tmp_path):
    assert 'expected a call of recorder/start' in worker.enable(0).message
    assert 'expected a call of recorder/start' in worker.finish(1).message
    (tmp_path / 'r1').mkdir()
    response = worker.start(tmp_path / 'r1')
    assert not response.success
    assert 'exists already, expected a new directory' in response.message
    assert 'expected both to be named' in worker.start(tmp_path / 'r2', run_id='').message


def test_full_disk_ends_the_run_with_the_reason_and_not_the_node(worker, tmp_path):
    worker.start(tmp_path / 'r1')
    worker.report(0, 0)
    assert worker.spin_until(lambda: worker.recorder._recording.results == {0})
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    # Files may grow no further: the kernel refuses, as it does when a disk is full.
    resource.setrlimit(resource.RLIMIT_FSIZE, (1000, hard))
    try:
        worker.report(1, 0)
        assert worker.spin_until(lambda: worker.recorder._failure)
        response = worker.finish(2)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert not response.success
    assert 'r1: cannot write: File too large; the 2 messages recorded so far' in response.message
    assert worker.start(tmp_path / 'r2', run_id='r2').success
    worker.report(0, 0, run_id='r2')
    assert worker.finish(1).success
    assert list(read_run(salvage(tmp_path / 'r1')).episodes.index) == [0]


def test_stamps_before_1970_are_dropped_and_counted(worker, tmp_path):
    assert worker.start(tmp_path / 'r1').success
    assert worker.enable(0).success
    last_ns = worker.play_episode(0, 20)
    worker.sample(-1_000_000_000)
    assert worker.disable(0, last_ns).success
    worker.report(0, -1_000_000_000)
    worker.report(0, last_ns)
    assert worker.finish(1).success
    assert worker.recorder._dropped == 4  # three samples and a result
    assert list(read_run(tmp_path / 'r1').episodes.index) == [0]


@pytest.mark.parametrize('count', [1, 4_294_967_295])
def test_counts_of_any_size_are_answered(worker, tmp_path, count):
    worker.recorder.set_parameters([Parameter('result_timeout', value=0.1)])
    assert worker.start(tmp_path / 'r1').success
    response = worker.finish(count)
    assert not response.success
    assert f'0 of {count} episode results' in response.message


def test_an_episode_may_be_said_to_end_at_any_time(worker, tmp_path):
    worker.recorder.set_parameters([Parameter('drain_timeout', value=0.1)])
    assert worker.start(tmp_path / 'r1').success
    assert worker.enable(0).success
    worker.play_episode(0, 20)
    response = worker.disable(0, (2**31 - 1) * 1_000_000_000)
    assert response.success
    assert 'missing from' in response.message


def test_a_name_that_no_disk_takes_leaves_the_run_under_way_alone(worker, tmp_path):
    assert worker.start(tmp_path / 'r1').success
    response = worker.start(tmp_path / ('a' * 300))
    assert not response.success
    assert 'File name too long' in response.message
    worker.report(0, 0)
    assert worker.finish(1).success


def test_a_name_that_leaves_no_room_for_its_ending_is_answered(worker, tmp_path):
    response = worker.start(tmp_path / ('a' * 250))
    assert not response.success
    assert 'File name too long' in response.message
    assert worker.start(tmp_path / 'r1').success
