# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Sampled episodes, episode results and metadata reach the bag, and nothing before it is time."""

import pytest
from hexapod_doe.bags.run_record import is_complete, read_run, read_topic
from hexapod_interfaces.srv import FinishRecording, RecordEpisode
from hexapod_node.qos import LOCK_STEP
from rosbags.highlevel import AnyReader
from sensor_msgs.msg import JointState

pytestmark = pytest.mark.graph

PERIOD_NS = 25_000_000


def test_results_always_and_topics_of_sampled_episodes_only(worker, tmp_path):
    bag = tmp_path / 'r1'
    response = worker.record_run(bag)
    assert (response.success, response.message) == (True, '')
    assert response.bag == str(bag)
    run = read_run(bag)
    assert list(run.episodes.index) == [0, 1, 2]
    # 20 periods have 21 samples and 20 commands; the episode sampled begins at period 21.
    stamps = [stamp for stamp, _ in read_topic(bag, '/w0/joint_states')]
    assert stamps == [k * PERIOD_NS for k in range(21, 42)]
    assert [s for s, _ in read_topic(bag, 'cpg/command')] == stamps[:-1]
    assert next(m.clock.nanosec for _, m in read_topic(bag, 'clock')) == 525_000_000
    assert response.messages == 3 + 21 + 20 + 21
    with AnyReader([bag]) as reader:  # an independent reader takes all of it
        assert reader.message_count == response.messages
        for connection, _, raw in reader.messages():
            reader.deserialize(raw, connection.msgtype)


def test_bag_tells_the_run(worker, tmp_path):
    worker.record_run(tmp_path / 'r1')
    metadata = read_run(tmp_path / 'r1').metadata
    assert metadata['run_id'] == 'r1'
    assert metadata['seed'] == '7'
    assert metadata['checkpoint'] == 'r1.pt'
    assert metadata['status'] == 'complete'
    assert metadata['episodes'] == '3'
    assert metadata['sampled_episodes'] == '1'
    assert metadata['counts'].splitlines() == [
        '/w0/clock 21',
        '/w0/cpg/command 20',
        '/w0/episode_result 3',
        '/w0/joint_states 21',
    ]
    assert metadata['incomplete'] == ''
    assert is_complete(tmp_path / 'r1')


def test_enable_answers_when_every_topic_is_matched(worker, tmp_path):
    worker.start(tmp_path / 'r1')
    assert worker.publishers['/w0/joint_states'].get_subscription_count() == 0
    response = worker.enable(0)
    assert sorted(response.topics) == sorted(worker.publishers)
    assert all(p.get_subscription_count() == 1 for p in worker.publishers.values())
    response = worker.disable(0, 0)
    assert list(response.topics) == []
    assert worker.spin_until(
        lambda: all(not p.get_subscription_count() for p in worker.publishers.values())
    )


def test_enable_waits_for_a_publisher_and_other_calls_go_on_meanwhile(worker, tmp_path):
    worker.start(tmp_path / 'r1')
    late = '/w0/joint_states'
    worker.node.destroy_publisher(worker.publishers.pop(late))
    answer = worker.call_async(RecordEpisode, episode=0, enable=True)
    worker.report(0, 0)
    assert worker.spin_until(lambda: worker.recorder._recording.results == {0})
    assert not answer.done()
    worker.publishers[late] = worker.node.create_publisher(JointState, late, LOCK_STEP)
    assert worker.spin_until(answer.done)
    assert answer.result().success


def test_finish_waits_for_a_late_result(worker, tmp_path):
    worker.start(tmp_path / 'r1')
    answer = worker.call_async(FinishRecording, episodes=1)
    worker.spin_until(lambda: False, timeout=0.1)
    assert not answer.done()
    worker.report(0, 0)
    assert worker.spin_until(answer.done)
    assert answer.result().success
