# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The recorder on a live graph: sampled episodes, completeness, refusals, unfinished bags."""

import os
import time
from array import array
from pathlib import Path

import pytest
import rclpy
from diagnostic_msgs.msg import KeyValue
from hexapod_doe.bag import find_bags, is_complete, read_run, read_topic
from hexapod_doe.recorder_node import RecorderNode
from hexapod_doe.salvage import salvage
from hexapod_interfaces.msg import CpgCommand, EpisodeResult
from hexapod_interfaces.srv import FinishRecording, RecordEpisode, StartRecording
from hexapod_node.qos import LOCK_STEP
from rclpy.experimental.events_executor import EventsExecutor
from rclpy.parameter import Parameter
from rosbags.highlevel import AnyReader
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState

pytestmark = pytest.mark.graph

PERIOD_NS = 25_000_000
TOPICS = {
    '/w0/joint_states': JointState,
    '/w0/cpg/command': CpgCommand,
    '/w0/clock': Clock,
}


class Worker:
    """Stands in for sim, CPG and agent: publishes episodes and calls the recorder."""

    def __init__(self, **parameters: float) -> None:
        rclpy.init(args=['--ros-args', '-r', '__ns:=/w0'])
        self.recorder = RecorderNode()
        for name, value in parameters.items():
            self.recorder.set_parameters([Parameter(name, value=value)])
        self.node = rclpy.create_node('agent')
        self.executor = EventsExecutor()
        self.executor.add_node(self.recorder)
        self.executor.add_node(self.node)
        self.clients = {
            kind: self.node.create_client(kind, f'recorder/{name}')
            for kind, name in (
                (StartRecording, 'start'),
                (RecordEpisode, 'episode'),
                (FinishRecording, 'finish'),
            )
        }
        self.results = self.node.create_publisher(EpisodeResult, 'episode_result', LOCK_STEP)
        self.publishers = {
            name: self.node.create_publisher(kind, name, LOCK_STEP)
            for name, kind in TOPICS.items()
        }
        assert self.spin_until(
            lambda: (
                self.results.get_subscription_count()
                and all(client.service_is_ready() for client in self.clients.values())
            )
        )

    def spin_until(self, predicate, timeout: float = 10.0) -> bool:
        end = time.monotonic() + timeout
        while not predicate():
            if time.monotonic() > end:
                return False
            self.executor.spin_once(timeout_sec=0.02)
        return True

    def call_async(self, kind, **fields):
        return self.clients[kind].call_async(kind.Request(**fields))

    def call(self, kind, **fields):
        answer = self.call_async(kind, **fields)
        assert self.spin_until(answer.done)
        return answer.result()

    def start(self, bag: Path, run_id: str = 'r1', **metadata: str):
        entries = [KeyValue(key=key, value=value) for key, value in metadata.items()]
        return self.call(
            StartRecording, run_id=run_id, bag=str(bag), topics=list(TOPICS), metadata=entries
        )

    def enable(self, episode: int):
        return self.call(RecordEpisode, episode=episode, enable=True)

    def disable(self, episode: int, last_ns: int):
        request = RecordEpisode.Request(episode=episode, enable=False)
        request.last.sec, request.last.nanosec = divmod(last_ns, 1_000_000_000)
        answer = self.clients[RecordEpisode].call_async(request)
        assert self.spin_until(answer.done)
        return answer.result()

    def finish(self, episodes: int, **metadata: str):
        entries = [KeyValue(key=key, value=value) for key, value in metadata.items()]
        return self.call(FinishRecording, episodes=episodes, metadata=entries)

    def sample(self, stamp_ns: int, command: bool = True, without: tuple[str, ...] = ()) -> None:
        """Publish one control period."""
        values = array('d', [stamp_ns * 1e-9])
        joints = JointState(name=['a'], position=values, velocity=values, effort=values)
        for name, message in (
            ('/w0/joint_states', joints),
            ('/w0/cpg/command', CpgCommand()),
            ('/w0/clock', Clock()),
        ):
            stamp = message.clock if name == '/w0/clock' else message.header.stamp
            stamp.sec, stamp.nanosec = divmod(stamp_ns, 1_000_000_000)
            if name not in without and (command or name != '/w0/cpg/command'):
                self.publishers[name].publish(message)

    def play_episode(self, start_ns: int, periods: int, **kwargs) -> int:
        """Publish an episode: one sample more than there are periods, and no last command."""
        for k in range(periods):
            self.sample(start_ns + k * PERIOD_NS, **kwargs)
        last_ns = start_ns + periods * PERIOD_NS
        self.sample(last_ns, command=False, **kwargs)
        return last_ns

    def report(self, episode: int, stamp_ns: int, steps: int = 20, run_id: str = 'r1') -> None:
        result = EpisodeResult(run_id=run_id, episode=episode, steps=steps)
        result.term_names, result.term_values = ['progress'], array('d', [1.0])
        result.header.stamp.sec, result.header.stamp.nanosec = divmod(stamp_ns, 1_000_000_000)
        self.results.publish(result)

    def close(self) -> None:
        for node in (self.recorder, self.node):
            node.destroy_node()
        self.executor.shutdown()
        rclpy.try_shutdown()


@pytest.fixture
def worker():
    worker = Worker(drain_timeout=0.3, match_timeout=0.5, result_timeout=0.3)
    yield worker
    worker.close()


def record_run(worker: Worker, bag: Path, episodes: int = 3, sampled: tuple[int, ...] = (1,)):
    """Record a run of which some episodes are sampled; return the answer of `finish`."""
    assert worker.start(bag, seed='7').success
    start_ns = 0
    for episode in range(episodes):
        if episode in sampled:
            assert worker.enable(episode).success
        last_ns = worker.play_episode(start_ns, 20)
        if episode in sampled:
            response = worker.disable(episode, last_ns)
            assert (response.success, response.message) == (True, '')
        worker.report(episode, last_ns)
        start_ns = last_ns + PERIOD_NS
    return worker.finish(episodes, checkpoint='r1.pt')


def test_results_always_and_topics_of_sampled_episodes_only(worker, tmp_path):
    bag = tmp_path / 'r1'
    response = record_run(worker, bag)
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
    record_run(worker, tmp_path / 'r1')
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
    assert sorted(response.topics) == sorted(TOPICS)
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


def test_finish_waits_for_a_late_result(worker, tmp_path):
    worker.start(tmp_path / 'r1')
    answer = worker.call_async(FinishRecording, episodes=1)
    worker.spin_until(lambda: False, timeout=0.1)
    assert not answer.done()
    worker.report(0, 0)
    assert worker.spin_until(answer.done)
    assert answer.result().success


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


def test_stopping_leaves_a_readable_unfinished_bag(tmp_path):
    worker = Worker()
    worker.start(tmp_path / 'r1')
    worker.report(0, 0)
    assert worker.spin_until(lambda: worker.recorder._recording.results == {0})
    worker.close()
    assert os.listdir(tmp_path) == ['r1.partial']
    with AnyReader([tmp_path / 'r1.partial']) as reader:
        assert reader.message_count == 1


def test_next_run_gives_up_the_open_one_and_sets_a_cut_one_aside(worker, tmp_path):
    bag = tmp_path / 'r1'
    for attempt in range(2):
        assert worker.start(bag, attempt=str(attempt)).success
        worker.report(0, 0)
        assert worker.spin_until(lambda: worker.recorder._recording.results == {0})
    assert worker.finish(1).success
    assert sorted(os.listdir(tmp_path)) == ['r1', 'r1.cut_1']
    assert read_run(bag).metadata['attempt'] == '1'


def test_refusals_name_what_was_expected(worker, tmp_path):
    assert 'expected a call of recorder/start' in worker.enable(0).message
    assert 'expected a call of recorder/start' in worker.finish(1).message
    (tmp_path / 'r1').mkdir()
    response = worker.start(tmp_path / 'r1')
    assert not response.success
    assert 'exists already, expected a new directory' in response.message
    assert 'expected both to be named' in worker.start(tmp_path / 'r2', run_id='').message
