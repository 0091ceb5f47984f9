# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What a recorded message costs, in time and bytes, written to a bag and taken from the graph.

Run: `python tests/benchmarks/bench_recorder.py`. Messages are joint states of 18 joints with
random values, which compress badly; results are episode results of a run of 1000 episodes.
"""

import multiprocessing
import tempfile
import time
from array import array
from pathlib import Path

import numpy as np
import rclpy
from hexapod_agent.learning.metrics import METRICS
from hexapod_doe.bags.recording import Recording
from hexapod_doe.bags.rosbag2 import Topic
from hexapod_doe.bags.run_bag import EPISODE_RESULT
from hexapod_doe.nodes.recorder_node import RecorderNode
from hexapod_interfaces.msg import EpisodeResult
from hexapod_interfaces.srv import RecordEpisode, StartRecording
from hexapod_node.qos import LOCK_STEP
from hexapod_sim.robot import CONTROL_PERIOD_NS
from rclpy.experimental.events_executor import EventsExecutor
from rclpy.serialization import serialize_message
from rich.console import Console
from rich.table import Table
from sensor_msgs.msg import JointState

EPISODES, PERIODS, TOPICS = 1000, 600, 20
JOINT_STATE = 'sensor_msgs/msg/JointState'
RANDOM = np.random.default_rng(0)


def joint_state(period: int) -> JointState:
    """Return a full joint state of a control period."""
    values = [array('d', RANDOM.normal(size=18).tolist()) for _ in range(3)]
    message = JointState(name=[f'joint_{k}' for k in range(18)])
    message.position, message.velocity, message.effort = values
    stamp = divmod(period * CONTROL_PERIOD_NS, 1_000_000_000)
    message.header.stamp.sec, message.header.stamp.nanosec = stamp
    return message


def episode_result(episode: int) -> bytes:
    """Return a serialised result with random numbers."""
    numbers = RANDOM.normal(size=12).tolist()
    message = EpisodeResult(
        run_id='bench',
        episode=episode,
        steps=PERIODS,
        episode_return=numbers[0],
        average_return=numbers[1],
        term_names=['forward', 'line', 'height', 'effort', 'alive'],
        term_values=array('d', numbers[2:7]),
        cause='time_limit',
        metric_names=[metric.name for metric in METRICS],
        metric_values=array('d', numbers[7:12]),
    )
    return serialize_message(message)


def write_samples(folder: Path) -> tuple[float, float]:
    """Return seconds and bytes per message of a sampled episode, without the graph."""
    topics = [Topic(f'/topic_{k}', JOINT_STATE) for k in range(TOPICS)]
    periods = [[serialize_message(joint_state(k)) for _ in topics] for k in range(PERIODS)]
    recording = Recording('bench', folder / 'samples', {}, CONTROL_PERIOD_NS)
    recording.begin_sample(0, topics)
    begin = time.perf_counter()
    for messages in periods:
        for topic, message in zip(topics, messages, strict=True):
            recording.add_sample(topic.name, message)
    seconds = time.perf_counter() - begin
    return seconds / (PERIODS * TOPICS), size(recording.finish(0, {})) / (PERIODS * TOPICS)


def write_results(folder: Path) -> tuple[float, float]:
    """Return seconds and bytes per episode of a run without sampled episodes."""
    topic = Topic('/episode_result', EPISODE_RESULT)
    results = [episode_result(k) for k in range(EPISODES)]
    recording = Recording('bench', folder / 'results', {}, CONTROL_PERIOD_NS)
    begin = time.perf_counter()
    for episode, result in enumerate(results):
        recording.add_result(topic, result, episode, PERIODS)
    seconds = time.perf_counter() - begin
    return seconds / EPISODES, size(recording.finish(EPISODES, {})) / EPISODES


def record_from_graph(folder: Path) -> float:
    """Return seconds of the recorder's processor per message that another process publishes."""
    rclpy.init()
    recorder, client = RecorderNode(), rclpy.create_node('client')
    executor = EventsExecutor()
    executor.add_node(recorder)
    executor.add_node(client)
    topics = [f'/topic_{k}' for k in range(TOPICS)]

    def call(kind: type, name: str, **fields: object) -> None:
        future = client.create_client(kind, f'/recorder/{name}')
        while not future.service_is_ready():
            executor.spin_once(timeout_sec=0.1)
        answer = future.call_async(kind.Request(**fields))
        while not answer.done():
            executor.spin_once(timeout_sec=0.1)
        assert answer.result().success, answer.result().message

    publisher = multiprocessing.get_context('spawn').Process(target=publish, args=(topics,))
    publisher.start()
    call(StartRecording, 'start', run_id='bench', bag=str(folder / 'graph'), topics=topics)
    call(RecordEpisode, 'episode', episode=0, enable=True)
    begin = time.process_time()
    while recorder._recording.messages < PERIODS * TOPICS:
        executor.spin_once(timeout_sec=0.5)
    seconds = time.process_time() - begin
    publisher.join()
    executor.shutdown()
    recorder.destroy_node()
    client.destroy_node()
    rclpy.try_shutdown()
    return seconds / (PERIODS * TOPICS)


def publish(topics: list[str]) -> None:
    """Publish an episode at four times real time, once all topics are matched."""
    rclpy.init()
    node = rclpy.create_node('source')
    publishers = [node.create_publisher(JointState, topic, LOCK_STEP) for topic in topics]
    while not all(publisher.get_subscription_count() for publisher in publishers):
        time.sleep(0.01)
    for period in range(PERIODS):
        message = joint_state(period)
        for publisher in publishers:
            publisher.publish(message)
        time.sleep(CONTROL_PERIOD_NS * 1e-9 / 4)
    time.sleep(1.0)
    node.destroy_node()
    rclpy.try_shutdown()


def size(bag: Path) -> int:
    """Return the bytes of a bag."""
    return sum(file.stat().st_size for file in bag.iterdir())


def main() -> None:
    """Print the table."""
    table = Table('what', 'µs', 'bytes')
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        seconds, size_each = write_samples(folder)
        table.add_row(
            'message of a sampled episode, written', f'{seconds * 1e6:.1f}', f'{size_each:.0f}'
        )
        seconds, size_each = write_results(folder)
        table.add_row(
            'episode result, written and flushed', f'{seconds * 1e6:.1f}', f'{size_each:.0f}'
        )
        seconds = record_from_graph(folder)
        table.add_row('message of a sampled episode, off the graph', f'{seconds * 1e6:.1f}', '')
    Console().print(table)


if __name__ == '__main__':
    main()
