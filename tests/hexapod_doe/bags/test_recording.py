# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A run's bag while it is open, without the graph."""

import pytest
from hexapod_doe.bags.bag_file import BagFile
from hexapod_doe.bags.recording import Recording
from hexapod_doe.bags.rosbag2 import Topic
from hexapod_doe.bags.run_record import read_run
from hexapod_doe.errors import BagError

PERIOD_NS = 25_000_000


@pytest.fixture
def recording(tmp_path):
    return Recording('r1', tmp_path / 'r1', {'seed': '7', 'status': 'mine'}, PERIOD_NS)


@pytest.mark.parametrize('stated', ['', 'two', '-1', '2.5', '9' * 5000])
def test_an_evaluation_of_no_known_length_is_refused(tmp_path, stated):
    with pytest.raises(BagError, match=r'metadata key evaluation is .*, expected a number'):
        Recording('r1', tmp_path / 'b', {'evaluation': stated}, PERIOD_NS)
    assert not list(tmp_path.iterdir())


def test_messages_are_logged_at_their_own_stamp(recording, samples):
    recording.begin_sample(0, [samples.joints])
    for stamp in (PERIOD_NS, 2 * PERIOD_NS):
        recording.add_sample(samples.joints.name, samples.serialised_joints(stamp))
    assert recording.end_sample(2 * PERIOD_NS) == []
    recording.add_result(samples.results, samples.serialised_result(0), 0, 1)
    bag = recording.finish(1, {})
    assert [(m.topic, m.time_ns) for m in BagFile(bag).messages()] == [
        (samples.joints.name, PERIOD_NS),
        (samples.joints.name, 2 * PERIOD_NS),
        (samples.results.name, 15_000_000_000),
    ]


def test_type_without_stamp_is_logged_at_the_newest_stamp(recording, samples):
    recording.begin_sample(0, [samples.joints, Topic('/note', 'std_msgs/msg/String')])
    recording.add_sample(samples.joints.name, samples.serialised_joints(3 * PERIOD_NS))
    recording.add_sample('/note', b'\x00\x01\x00\x00\x01\x00\x00\x00\x00')
    assert recording.waiting(3 * PERIOD_NS) == []
    assert recording.end_sample(3 * PERIOD_NS) == []
    assert [m.time_ns for m in BagFile(recording.finish(0, {})).messages()] == [3 * PERIOD_NS] * 2


def test_samples_outside_a_sampled_episode_are_left_out(recording, samples):
    recording.add_sample(samples.joints.name, samples.serialised_joints(0))
    assert recording.messages == 0
    assert recording.waiting(0) == []
    assert recording.end_sample(0) == []


def test_second_result_of_an_episode_is_not_stored(recording, samples):
    assert recording.add_result(samples.results, samples.serialised_result(0), 0, 600)
    assert not recording.add_result(samples.results, samples.serialised_result(0), 0, 600)
    assert recording.messages == 1


def test_episodes_are_compared_by_number(recording, samples):
    for episode in (0, 2):
        recording.add_result(samples.results, samples.serialised_result(episode), episode, 600)
    assert [recording.first_lacking(count) for count in (1, 4, 4_000_000_000)] == [None, 1, 1]
    with pytest.raises(BagError, match='2 of 4 episode results recorded, episode 1 is the first'):
        recording.finish(4, {})
    with pytest.raises(BagError, match='was not finished'):
        read_run(recording.bag)


def test_what_the_recorder_knows_stands_above_what_it_was_told(recording, samples):
    recording.add_result(samples.results, samples.serialised_result(0), 0, 600)
    metadata = read_run(recording.finish(1, {'episodes': '99', 'checkpoint': 'x'})).metadata
    assert metadata['status'] == 'complete'
    assert metadata['episodes'] == '1'
    assert metadata['seed'] == '7'
    assert metadata['checkpoint'] == 'x'
