# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The player on a live graph: the recorded bytes, their clock, their timing, its services."""

import statistics
import subprocess
import sys
import time
from array import array
from functools import cache
from pathlib import Path

import pytest
from diagnostic_msgs.msg import DiagnosticArray
from hexapod_doe.bags.bag_file import BagFile
from hexapod_doe.bags.bag_writer import BagWriter
from hexapod_doe.bags.rosbag2 import OfferedQos, Topic
from hexapod_doe.errors import BagError
from hexapod_doe.nodes.player_node import PlayerNode
from hexapod_node.qos import LOCK_STEP
from hexapod_node.raw_topics import subscribe_raw
from rclpy.parameter import Parameter
from rclpy.serialization import serialize_message
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger

pytestmark = pytest.mark.graph

PERIOD_NS = 25_000_000
CASES = Path(__file__).resolve().parents[1] / 'data' / 'cases'
SAMPLE = Path(__file__).resolve().parents[2] / 'bags' / 'sample'
TYPES = {'/w0/joint_states': 'sensor_msgs/msg/JointState', '/w0/clock': 'rosgraph_msgs/msg/Clock'}


@cache  # what fills the gaps between numbers differs from one serialisation to the next
def joints(stamp_ns: int) -> bytes:
    values = array('d', [stamp_ns * 1e-9])
    message = JointState(name=['a'], position=values, velocity=values, effort=values)
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp_ns, 1_000_000_000)
    return serialize_message(message)


@pytest.fixture
def bag(tmp_path) -> Path:
    """A bag of 40 periods that begins at 100 s, with a clock of its own."""
    with BagWriter(tmp_path / 'run', {'run_id': 'run'}) as writer:
        for name, kind in TYPES.items():
            writer.add_topic(Topic(name, kind))
        for k in range(40):
            stamp = 100_000_000_000 + k * PERIOD_NS
            writer.write('/w0/joint_states', joints(stamp), stamp)
            writer.write('/w0/clock', serialize_message(Clock()), stamp)
    return tmp_path / 'run'


class Listener:
    """Notes what the player publishes, and when it came."""

    def __init__(self, graph, topics) -> None:
        self.heard: list[tuple[str, bytes, float]] = []
        self.clock: list[int] = []
        node = graph.nodes[0]
        for name, kind in topics.items():
            subscribe_raw(node, name, kind, self._noting(name), LOCK_STEP)
        node.create_subscription(Clock, '/clock', self._on_clock, LOCK_STEP)

    def _noting(self, name):
        return lambda data: self.heard.append((name, data, time.monotonic()))

    def _on_clock(self, message) -> None:
        self.clock.append(message.clock.sec * 1_000_000_000 + message.clock.nanosec)


def add_player(graph, bag, **parameters) -> PlayerNode:
    """Add a player, paused unless told otherwise."""
    values = {'bag': str(bag), 'paused': True} | parameters
    overrides = [Parameter(name, value=value) for name, value in values.items()]
    return graph.add(PlayerNode(parameter_overrides=overrides))


def add_heard_player(graph, bag, **parameters) -> PlayerNode:
    """Add a player whose listener is matched."""
    player = add_player(graph, bag, **parameters)
    publishers = (player._clock_publisher, *player._bag_publishers.values())
    graph.until(lambda: all(publisher.get_subscription_count() for publisher in publishers))
    return player


def ask(graph, verb):
    return graph.call(Trigger, f'/player/{verb}', Trigger.Request())


def test_bytes_and_clock_come_back(graph, bag):
    listener = Listener(graph, {'/w0/joint_states': TYPES['/w0/joint_states']})
    player = add_heard_player(graph, bag, rate=0.0)
    assert ask(graph, 'resume').success
    graph.until(lambda: player.exit_status == 0 and len(listener.clock) == 40)
    graph.until(lambda: len(listener.heard) == 40)  # topics come in no order among each other
    stamps = [100_000_000_000 + k * PERIOD_NS for k in range(40)]
    assert [data for _, data, _ in listener.heard] == [joints(stamp) for stamp in stamps]
    assert listener.clock == stamps


def test_recorded_clock_is_left_out(graph, bag):
    player = add_player(graph, bag)
    assert player.count_publishers('/w0/clock') == 0
    assert player.count_publishers('/w0/joint_states') == 1


def median_error(heard: list[tuple[float, int]]) -> float:
    """Distance of what came from its stamps, seconds; where both begin does not matter."""
    delays = [at - stamp * 1e-9 for at, stamp in heard]
    usual = statistics.median(delays)
    return statistics.median(abs(delay - usual) for delay in delays)


def least_error(heard: list[tuple[float, int]], size: int) -> float:
    """Least median error of a whole round: a busy machine delays some of them."""
    rounds = [heard[i : i + size] for i in range(0, len(heard) - size + 1, size)]
    return min(map(median_error, rounds), default=float('inf'))


@pytest.mark.alone
def test_real_time_is_kept_within_2_ms(graph, bag):
    listener = Listener(graph, {'/w0/joint_states': TYPES['/w0/joint_states']})
    add_heard_player(graph, bag, loop=True)
    ask(graph, 'resume')

    def heard() -> list[tuple[float, int]]:
        return [(came, k % 40 * PERIOD_NS) for k, (_, _, came) in enumerate(listener.heard)]

    graph.until(lambda: least_error(heard(), 40) < 2e-3)


@pytest.mark.alone
def test_a_whole_graph_is_kept_within_2_ms(graph, monkeypatch):
    topics = ' '.join(name for name in BagFile(SAMPLE).types if 'episode_result' not in name)
    player = add_player(graph, SAMPLE, start=14.0, topics=topics, loop=True)
    published: list[tuple[float, int]] = []
    publish = player._publish

    def note(frame):
        publish(frame)
        published.append((time.monotonic(), frame.time_ns))

    monkeypatch.setattr(player, '_publish', note)
    ask(graph, 'resume')
    graph.until(lambda: least_error(published, 42) < 2e-3)


@pytest.mark.alone
def test_rate_may_be_a_whole_number(graph):
    listener = Listener(graph, {'/hexapod/odom': 'nav_msgs/msg/Odometry'})
    player = add_heard_player(graph, SAMPLE, rate=0, topics='odom')
    began = time.monotonic()
    ask(graph, 'resume')
    graph.until(lambda: player.exit_status == 0 and len(listener.heard) == 601)
    assert time.monotonic() - began < 15.0 / 5


def test_it_reports_its_health(graph, bag):
    reports: list[DiagnosticArray] = []
    graph.nodes[0].create_subscription(DiagnosticArray, '/diagnostics', reports.append, 10)
    add_player(graph, bag)
    graph.until(lambda: reports)
    (status,) = reports[0].status
    assert (status.level, status.name, status.message) == (b'\0', '/player: state', 'paused')
    values = {entry.key: entry.value for entry in status.values}
    assert values == {'bag': str(bag), 'messages': '0', 'seconds': '0.000'}


def test_start_and_topics(graph, bag):
    listener = Listener(graph, {'/w0/joint_states': TYPES['/w0/joint_states']})
    player = add_heard_player(graph, bag, rate=0.0, start=0.5, topics='joint_states')
    ask(graph, 'resume')
    graph.until(lambda: player.exit_status == 0 and len(listener.heard) == 20)
    assert listener.heard[0][1] == joints(100_500_000_000)


def test_step_pause_and_loop(graph, bag):
    listener = Listener(graph, {'/w0/joint_states': TYPES['/w0/joint_states']})
    player = add_heard_player(graph, bag, rate=10.0, loop=True)
    response = ask(graph, 'step')
    assert (response.success, response.message) == (True, '100.000000000 s, 1 messages')
    graph.until(lambda: listener.clock == [100_000_000_000])
    ask(graph, 'resume')
    assert 'expected it to be paused' in ask(graph, 'step').message
    graph.until(lambda: len(listener.clock) > 50)
    ask(graph, 'pause')
    graph.until(lambda: len(listener.clock) == player._played)
    assert listener.clock[40] == listener.clock[0]
    assert player.exit_status is None


def test_bag_of_rosbag2_with_its_qos(graph, tmp_path):
    # Written by another library in the layout of rosbag2, version 8: policies are numbers.
    store = get_typestore(Stores.ROS2_JAZZY)
    with Writer(tmp_path / 'talk', version=8, storage_plugin=StoragePlugin.MCAP) as writer:
        connection = writer.add_connection('/chatter', 'std_msgs/msg/String', typestore=store)
        raw = store.serialize_cdr(
            store.types['std_msgs/msg/String'](data='hi'), connection.msgtype
        )
        writer.write(connection, 1_700_000_000_000_000_000, raw)
    listener = Listener(graph, {'/chatter': 'std_msgs/msg/String'})
    player = add_heard_player(graph, tmp_path / 'talk')
    ask(graph, 'resume')
    graph.until(lambda: player.exit_status == 0 and listener.heard)
    assert listener.heard[0][1] == bytes(raw)
    assert listener.clock == [1_700_000_000_000_000_000]


@pytest.mark.parametrize('offered', [('best_effort', 'volatile'), ('reliable', 'transient_local')])
def test_publishers_offer_what_was_recorded(graph, tmp_path, offered):
    reliability, durability = offered
    qos = OfferedQos(reliability=reliability, durability=durability)
    with BagWriter(tmp_path / 'b', {}) as writer:
        writer.add_topic(Topic('/joints', 'sensor_msgs/msg/JointState', (qos,)))
        writer.write('/joints', joints(0), 0)
    player = add_player(graph, tmp_path / 'b')
    (info,) = player.get_publishers_info_by_topic('/joints')
    assert info.qos_profile.reliability.name.lower() == reliability
    assert info.qos_profile.durability.name.lower() == durability


def test_nothing_to_play_is_refused(graph, bag):
    with pytest.raises(BagError, match=r"'bag' is not set, expected a bag: -p bag:=DIR"):
        add_player(graph, '')
    with pytest.raises(BagError, match=r'no message from start:=2\.0 s on, it lasts 0\.975 s'):
        add_player(graph, bag, start=2.0)
    with BagWriter(bag.with_name('none'), {}) as writer:
        writer.add_topic(Topic('/joints', 'sensor_msgs/msg/JointState'))
    with pytest.raises(BagError, match='empty, expected a message to play'):
        add_player(graph, bag.with_name('none'))


def test_damage_further_on_ends_the_playback_with_one_line(graph, tmp_path, capfd):
    with BagWriter(tmp_path / 'b', {}, chunk_bytes=2000) as writer:
        writer.add_topic(Topic('/joints', 'sensor_msgs/msg/JointState'))
        for k in range(200):
            writer.write('/joints', joints(k * PERIOD_NS), k * PERIOD_NS)
    file = tmp_path / 'b' / 'b_0.mcap'
    content = bytearray(file.read_bytes())
    middle = len(content) // 2
    content[middle : middle + 1500] = bytes(1500)
    file.write_bytes(content)
    player = add_player(graph, tmp_path / 'b', rate=0, paused=False)
    graph.until(lambda: player.exit_status is not None)
    assert player.exit_status == 1
    assert 0 < player._played < 200
    (line,) = [line for line in capfd.readouterr().err.splitlines() if '[player]' in line]
    assert f'[player]: bag {tmp_path / "b"}: ' in line
    assert 'damaged' in line
    assert line.endswith(f'; {player._played} messages were played')


def test_what_nobody_could_read_is_warned_of_and_left_out(graph, capfd):
    """A Range of Humble has no variance: by today's definition its bytes end too soon."""
    player = add_player(graph, CASES / 'b13_humble_range', rate=0, paused=False)
    assert player.count_publishers('/hexapod/body/height') == 0
    reports: list[DiagnosticArray] = []
    graph.nodes[0].create_subscription(DiagnosticArray, '/diagnostics', reports.append, 10)
    graph.until(lambda: player.exit_status == 0 and reports)
    assert player._played == 280
    (warning,) = [line for line in capfd.readouterr().err.splitlines() if 'WARN' in line]
    assert '/hexapod/body/height is not played: sensor_msgs/Range has' in warning
    (status,) = reports[-1].status
    assert (status.level, status.message) == (b'\1', 'playing a part of the bag')
    assert 'not played: /hexapod/body/height' in {entry.key for entry in status.values}


def test_a_jump_of_55_years_is_told_and_can_be_started_after(graph, capfd):
    player = add_player(graph, CASES / 'b07_time_zero', rate=100.0, paused=False)
    graph.until(lambda: player.exit_status == 0)
    assert player._played == 320
    (warning,) = [line for line in capfd.readouterr().err.splitlines() if 'WARN' in line]
    assert 'nothing was recorded for 55.8 years: passed over; start:=1760000000.050' in warning
    late = add_player(graph, CASES / 'b07_time_zero', start=1760000000.0)
    assert late._playback.next_ns == 1_760_000_000_050_000_000
    with pytest.raises(BagError, match=r'no message from start:=2000000000\.0 s on, it lasts'):
        add_player(graph, CASES / 'b07_time_zero', start=2e9)


def test_a_long_pause_is_told(graph, tmp_path, capfd):
    with BagWriter(tmp_path / 'b', {}) as writer:
        writer.add_topic(Topic('/joints', 'sensor_msgs/msg/JointState'))
        for stamp in (0, 10_800_000_000_000):
            writer.write('/joints', joints(stamp), stamp)
    player = add_player(graph, tmp_path / 'b', paused=False)
    graph.until(lambda: player._played == 1)
    graph.until(lambda: player._pauses._told_ns is not None)
    assert 'nothing is due for 3.0 hours; start:=10800.000' in capfd.readouterr().err


@pytest.mark.system
@pytest.mark.parametrize('fault', ['nowhere', 'empty', 'cut', 'foreign'])
def test_unusable_bag_is_one_line_and_status_1(bag, fault, told):
    if fault == 'nowhere':
        bag = bag.with_name('nowhere')
    elif fault == 'foreign':
        (bag / 'metadata.yaml').write_text('x: 1')
    else:
        file = bag / 'run_0.mcap'
        file.write_bytes(b'' if fault == 'empty' else file.read_bytes()[:-20])
    done = subprocess.run(
        [sys.executable, '-m', 'hexapod_doe.nodes.player_node', '--ros-args', '-p', f'bag:={bag}'],
        capture_output=True,
        text=True,
        timeout=30,
    )
    assert done.returncode == 1
    (line,) = told(done.stderr)
    assert f'bag {bag}: ' in line
    assert 'expected' in line
