# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import os
import threading
import time
from pathlib import Path

import pytest
import rclpy
import yaml
from mcap.writer import Writer
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.serialization import serialize_message
from ros2_mini.cli import main
from ros2_mini.discovery import wait_for
from rosgraph_msgs.msg import Clock
from std_msgs.msg import String

CASES = Path(__file__).resolve().parents[1] / 'data' / 'cases'
START = 1_700_000_000_000_000_000
PERIOD = 100_000_000
COUNT = 12


def make_bag(directory: Path, **changes) -> Path:
    """Write a bag of strings on two topics in turn, one every 0.1 s."""
    directory.mkdir()
    with (directory / 'x_0.mcap').open('wb') as stream:
        writer = Writer(stream)
        writer.start(profile='ros2')
        schema = writer.register_schema('std_msgs/msg/String', 'ros2msg', b'string data')
        channels = [writer.register_channel(topic, 'cdr', schema) for topic in ('/a', '/b')]
        for i in range(COUNT):
            data = serialize_message(String(data=str(i)))
            time_ns = START + i * PERIOD
            writer.add_message(channels[i % 2], time_ns, data, time_ns)
        writer.finish()
    topics = [
        {
            'topic_metadata': {
                'name': name,
                'type': 'std_msgs/msg/String',
                'serialization_format': 'cdr',
                'offered_qos_profiles': [],
            },
            'message_count': COUNT // 2,
        }
        for name in ('/a', '/b')
    ]
    information = {
        'version': 9,
        'storage_identifier': 'mcap',
        'duration': {'nanoseconds': (COUNT - 1) * PERIOD},
        'starting_time': {'nanoseconds_since_epoch': START},
        'message_count': COUNT,
        'topics_with_message_count': topics,
        'compression_mode': '',
        'relative_file_paths': ['x_0.mcap'],
        'ros_distro': 'jazzy',
    }
    content = {'rosbag2_bagfile_information': information | changes}
    (directory / 'metadata.yaml').write_text(yaml.safe_dump(content))
    return directory


@pytest.fixture
def bag(tmp_path: Path) -> Path:
    return make_bag(tmp_path / 'bag')


# The layout is that of rosbag2_py 0.26.5 (format_bag_metadata.cpp).
SUMMARY = """
Files:             x_0.mcap
Bag size:          {size}
Storage id:        mcap
ROS Distro:        jazzy
Duration:          1.100000000s
Start:             Nov 14 2023 22:13:20.000000000 (1700000000.000000000)
End:               Nov 14 2023 22:13:21.100000000 (1700000001.100000000)
Messages:          12
Topic information: Topic: /a | Type: std_msgs/msg/String | Count: 6 | Serialization Format: cdr
                   Topic: /b | Type: std_msgs/msg/String | Count: 6 | Serialization Format: cdr
Service:           0
Service information: 
"""  # noqa: W291


def test_info(bag, capsys, monkeypatch):
    monkeypatch.setenv('TZ', 'UTC')
    time.tzset()
    assert main(['bag', 'info', str(bag)]) == 0
    size = sum(os.path.getsize(path) for path in bag.iterdir()) / 1024
    assert capsys.readouterr().out == SUMMARY.format(size=f'{size:.1f} KiB')


def test_info_of_topic_names(bag, capsys):
    assert main(['bag', 'info', '-t', str(bag)]) == 0
    assert capsys.readouterr().out == '/a\n/b\n'


def test_info_of_one_file_below_the_home_directory(capsys, monkeypatch):
    monkeypatch.setenv('HOME', str(CASES))
    assert main(['bag', 'info', '~/plain_ok/plain_0.mcap']) == 0
    lines = capsys.readouterr().out.splitlines()
    assert 'Files:             plain_0.mcap' in lines
    assert 'Duration:          0.975000000s' in lines
    assert 'Messages:          320' in lines
    assert any(
        '/hexapod/imu/data | Type: sensor_msgs/msg/Imu | Count: 40' in line for line in lines
    )


@pytest.mark.parametrize(
    ('changes', 'message'),
    [
        ({'storage_identifier': 'sqlite3'}, "storage 'sqlite3', expected"),
        ({'compression_mode': 'FILE', 'compression_format': 'lz4'}, "compressed with 'lz4'"),
        ({'relative_file_paths': ['y.mcap']}, 'y.mcap is missing'),
        ({'relative_file_paths': ['metadata.yaml']}, 'metadata.yaml is damaged'),
    ],
)
def test_bag_that_cannot_be_read_is_one_line(changes, message, tmp_path, capsys):
    bag = make_bag(tmp_path / 'bag', **changes)
    assert main(['bag', 'play', str(bag)]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(f'bag {bag}: ')
    assert message in line


def test_metadata_that_is_missing_or_broken(tmp_path, capsys):
    def complaint(path: Path) -> str:
        assert main(['bag', 'info', str(path)]) == 1
        (line,) = capsys.readouterr().err.splitlines()
        return line

    assert f'bag {tmp_path}/none: no such directory' in complaint(tmp_path / 'none')
    assert f'cure: give {CASES}/b01_write_split' in complaint(CASES)
    assert 'no metadata.yaml' in complaint(tmp_path)
    (tmp_path / 'metadata.yaml').write_text('rosbag2_bagfile_information: {version: 9}')
    assert "metadata.yaml lacks 'relative_file_paths'" in complaint(tmp_path)


def test_unknown_topic_is_named(bag, capsys):
    assert main(['bag', 'play', str(bag), '--topics', '/c']) == 1
    assert capsys.readouterr().err == f"bag '{bag}' has no topic '/c'; it has: /a, /b\n"


@pytest.fixture
def listener():
    """Collect what arrives on `/a2` and `/clock` while a bag plays."""
    context = rclpy.Context()
    rclpy.init(context=context)
    node = rclpy.create_node('listener', context=context)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    heard: dict[str, list] = {'/a2': [], '/clock': []}
    node.create_subscription(String, '/a2', heard['/a2'].append, 100)
    node.create_subscription(
        Clock,
        '/clock',
        heard['/clock'].append,
        QoSProfile(depth=100, reliability=ReliabilityPolicy.BEST_EFFORT),
    )
    thread = threading.Thread(target=executor.spin)
    thread.start()
    yield heard
    executor.shutdown()
    rclpy.shutdown(context=context)
    thread.join()
    node.destroy_node()


@pytest.mark.system
@pytest.mark.alone
def test_play_with_a_clock(bag, listener, start):
    words = ['--topics', '/a', '--remap', '/a:=/a2', '-r', '2', '--clock']
    process = start('bag', 'play', str(bag), '--start-offset', '0.3', *words)
    process.communicate(timeout=60)
    assert process.returncode == 0
    # /a has the messages 0, 2, ... 10, every 0.2 s; the first from 0.3 s on is number 4.
    assert wait_for(lambda: len(listener['/a2']) >= 4, 10.0)
    assert [message.data for message in listener['/a2']] == ['4', '6', '8', '10']
    ticks = [tick.clock.sec * 10**9 + tick.clock.nanosec - START for tick in listener['/clock']]
    assert ticks == [4 * PERIOD, 6 * PERIOD, 8 * PERIOD, 10 * PERIOD]


@pytest.mark.system
@pytest.mark.parametrize(
    ('case', 'warning'),
    [
        ('b13_humble_range', '/hexapod/body/height is not played: sensor_msgs/Range has'),
        ('b07_time_zero', 'nothing was recorded for 55.8 years: passed over; start:=1760'),
    ],
)
def test_what_nobody_could_read_and_jumps_are_told(case, warning, start):
    process = start('bag', 'play', str(CASES / case))
    told = process.communicate(timeout=60)[0]
    assert process.returncode == 0
    (line,) = [line for line in told.splitlines() if 'WARN' in line]
    assert warning in line
