# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A worker of stand-ins around a real recorder."""

import time
from array import array
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
import rclpy
from diagnostic_msgs.msg import KeyValue
from hexapod_doe.nodes.recorder_node import RecorderNode
from hexapod_interfaces.msg import CpgCommand, EpisodeResult
from hexapod_interfaces.srv import FinishRecording, RecordEpisode, StartRecording
from hexapod_node.qos import LOCK_STEP
from hexapod_node.root import root_arguments
from rclpy.experimental.events_executor import EventsExecutor
from rclpy.parameter import Parameter
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState

PERIOD_NS = 25_000_000
TOPICS = {
    '/w0/joint_states': JointState,
    '/w0/cpg/command': CpgCommand,
    '/w0/clock': Clock,
}


class Worker:
    """Stands in for sim, CPG and agent: publishes episodes and calls the recorder."""

    def __init__(self, **parameters: float) -> None:
        rclpy.init(args=['--ros-args', '-r', '__ns:=/w0', *root_arguments('/')])
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

    def spin_until(self, predicate: Callable[[], bool], timeout: float = 10.0) -> bool:
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

    def record_run(self, bag: Path, episodes: int = 3, sampled: tuple[int, ...] = (1,)):
        """Record a run of which some episodes are sampled; return the answer of `finish`."""
        assert self.start(bag, seed='7').success
        start_ns = 0
        for episode in range(episodes):
            if episode in sampled:
                assert self.enable(episode).success
            last_ns = self.play_episode(start_ns, 20)
            if episode in sampled:
                response = self.disable(episode, last_ns)
                assert (response.success, response.message) == (True, '')
            self.report(episode, last_ns)
            start_ns = last_ns + PERIOD_NS
        return self.finish(episodes, checkpoint='r1.pt')

    def close(self) -> None:
        """End it; once more does nothing."""
        if rclpy.ok():
            self.executor.shutdown()
            for node in (self.recorder, self.node):
                node.destroy_node()
            rclpy.shutdown()


@pytest.fixture
def worker() -> Iterator[Worker]:
    """Yield a worker whose recorder waits briefly."""
    worker = Worker(drain_timeout=0.3, match_timeout=0.5, result_timeout=0.3)
    yield worker
    worker.close()
