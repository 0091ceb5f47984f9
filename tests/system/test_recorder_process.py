# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The recorder as a process: what its end by each signal leaves on the disk."""

import os
import signal
import subprocess
import sys
import time
from array import array

import pytest
import rclpy
from hexapod_doe.bags.run_record import read_run
from hexapod_doe.bags.salvage import salvage
from hexapod_interfaces.msg import EpisodeResult
from hexapod_interfaces.srv import StartRecording
from hexapod_node.qos import LOCK_STEP
from rclpy.executors import SingleThreadedExecutor
from rosbags.rosbag2 import Reader

pytestmark = pytest.mark.system

RESULTS = 30


@pytest.fixture
def recorder(tmp_path):
    """A recorder process with an open run, to which RESULTS results were published."""
    command = [sys.executable, '-m', 'hexapod_doe.nodes.recorder_node', '--ros-args']
    process = subprocess.Popen([*command, '-p', f'root:={tmp_path}'])
    rclpy.init()
    node = rclpy.create_node('agent')
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    client = node.create_client(StartRecording, '/recorder/start')
    publisher = node.create_publisher(EpisodeResult, '/episode_result', LOCK_STEP)
    assert client.wait_for_service(timeout_sec=20.0)
    future = client.call_async(StartRecording.Request(run_id='r1', bag=str(tmp_path / 'r1')))
    executor.spin_until_future_complete(future, timeout_sec=10.0)
    assert future.result().success
    while not publisher.get_subscription_count():
        time.sleep(0.01)
    for episode in range(RESULTS):
        result = EpisodeResult(run_id='r1', episode=episode)
        result.term_names, result.term_values = ['forward'], array('d', [1.0])
        publisher.publish(result)
        time.sleep(0.002)
    publisher.wait_for_all_acked()
    yield process
    process.kill()
    process.wait()
    executor.shutdown()
    node.destroy_node()
    rclpy.shutdown()


def size(path) -> int:
    return path.stat().st_size if path.exists() else 0


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
def test_signal_leaves_a_readable_unfinished_bag(recorder, tmp_path, number):
    recorder.send_signal(number)
    assert recorder.wait(timeout=10.0) == 0
    assert os.listdir(tmp_path) == ['r1.partial']
    with Reader(tmp_path / 'r1.partial') as reader:
        assert 0 < reader.message_count <= RESULTS


def test_killed_recorder_loses_nothing_that_it_had_taken(recorder, tmp_path):
    # Every result is flushed when it is taken: the file stops growing when all have come.
    file = tmp_path / 'r1.partial' / 'r1_0.mcap'
    before = -1
    while size(file) != before:
        before = size(file)
        time.sleep(0.3)
    recorder.kill()
    recorder.wait()
    run = read_run(salvage(tmp_path / 'r1'))
    assert list(run.episodes.index) == list(range(RESULTS))
    assert run.metadata['status'] == 'salvaged'
