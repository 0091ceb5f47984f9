# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Bags for the tests of everything that reads and writes them.

ROS is imported where it is needed, so that the tests of the statistics run without it.
"""

from array import array
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import pytest
from hexapod_doe.bags.bag_writer import BagWriter
from hexapod_doe.bags.rosbag2 import Topic

PERIOD_NS = 25_000_000
EPISODE_NS = 15_000_000_000
RESULTS = Topic('/w0/episode_result', 'hexapod_interfaces/msg/EpisodeResult')
EVALUATION = Topic('/w0/evaluation_result', RESULTS.type_name)
JOINTS = Topic('/w0/joint_states', 'sensor_msgs/msg/JointState')


def serialised_result(episode: int, run_id: str = 'r1', gain: float = 1.0) -> bytes:
    """Return the result of an episode that ends at (episode + 1) * 15 s.

    It returns 10 * episode * gain, and 5 * episode * gain on average so far.
    """
    from hexapod_interfaces.msg import EpisodeResult
    from rclpy.serialization import serialize_message

    message = EpisodeResult(
        run_id=run_id,
        episode=episode,
        steps=600,
        episode_return=float(10 * episode * gain),
        average_return=float(5 * episode * gain),
        term_names=['progress', 'effort'],
        term_values=array('d', [10.0 * episode + 1.0, -1.0]),
        cause='time limit',
        metric_names=['critic_loss', 'entropy'],
        metric_values=array('d', [float('nan'), 1.5]),
    )
    message.header.stamp.sec = 15 * (episode + 1)
    return serialize_message(message)


def serialised_joints(stamp_ns: int) -> bytes:
    """Return a joint state whose first angle is its stamp in seconds."""
    from rclpy.serialization import serialize_message
    from sensor_msgs.msg import JointState

    values = array('d', [stamp_ns * 1e-9] + [0.0] * 17)
    message = JointState(
        name=[f'joint_{k}' for k in range(18)], position=values, velocity=values, effort=values
    )
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp_ns, 1_000_000_000)
    return serialize_message(message)


def fill(
    writer: BagWriter, episodes: int, samples: int = 0, gain: float = 1.0, evaluation: int = 0
) -> None:
    """Write results, before each of them some joint states, and those of an evaluation."""
    writer.add_topic(JOINTS)
    writer.add_topic(RESULTS)
    for episode in range(episodes):
        for k in range(samples):
            stamp = episode * EPISODE_NS + k * PERIOD_NS
            writer.write(JOINTS.name, serialised_joints(stamp), stamp)
        end = (episode + 1) * EPISODE_NS
        writer.write(RESULTS.name, serialised_result(episode, gain=gain), end)
        writer.flush()
    for start in range(evaluation):
        writer.add_topic(EVALUATION)
        end = (episodes + start + 1) * EPISODE_NS
        writer.write(EVALUATION.name, serialised_result(start, gain=gain), end)


@pytest.fixture
def samples() -> SimpleNamespace:
    """What the bags of these tests are made of."""
    return SimpleNamespace(
        joints=JOINTS,
        results=RESULTS,
        fill=fill,
        serialised_joints=serialised_joints,
        serialised_result=serialised_result,
    )


@pytest.fixture
def write_bag(tmp_path: Path) -> Callable[..., Path]:
    """Return a function that writes the bag of a complete run and returns its path."""

    def write(
        name: str = 'r1',
        episodes: int = 3,
        samples: int = 4,
        gain: float = 1.0,
        evaluation: int = 0,
        **metadata: str,
    ) -> Path:
        described = {'run_id': 'r1', 'status': 'complete', 'episodes': str(episodes)}
        described |= {'evaluation': str(evaluation)} if evaluation else {}
        with BagWriter(tmp_path / name, described | metadata) as writer:
            fill(writer, episodes, samples, gain, evaluation)
        return tmp_path / name

    return write
