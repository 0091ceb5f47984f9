# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Runs come back from their bags, and every unusable bag is named with its fault."""

import math
import shutil
import subprocess
import sys

import pytest
from hexapod_doe.bags.bag_state import sound_metadata
from hexapod_doe.bags.bag_writer import BagWriter
from hexapod_doe.bags.run_record import find_bags, is_complete, read_run, read_topic
from hexapod_doe.bags.verify import verify
from hexapod_doe.errors import BagError, UnfinishedError
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore


def test_run_comes_back(write_bag):
    run = read_run(write_bag(observations='ABCDE', seed='7'))
    assert run.run_id == 'r1'
    assert run.metadata['observations'] == 'ABCDE'
    assert run.metadata['seed'] == '7'
    episodes = run.episodes
    assert list(episodes.index) == [0, 1, 2]
    assert list(episodes['episode_return']) == [0.0, 10.0, 20.0]
    assert list(episodes['term_progress']) == [1.0, 11.0, 21.0]
    assert list(episodes['stamp_ns']) == [15_000_000_000, 30_000_000_000, 45_000_000_000]
    assert math.isnan(episodes['critic_loss'][0])
    assert list(episodes['entropy']) == [1.5] * 3  # a name of the learner's own
    assert list(episodes['cause']) == ['time limit'] * 3


def test_later_metadata_holds(tmp_path, samples):
    with BagWriter(tmp_path / 'b', {'run_id': 'b', 'status': 'recording'}) as writer:
        samples.fill(writer, 1)
        writer.metadata['status'] = 'complete'
    assert read_run(tmp_path / 'b').metadata['status'] == 'complete'


def test_topic_by_full_name_and_by_its_end(write_bag):
    bag = write_bag(episodes=2, samples=3)
    full = [(stamp, message.position[0]) for stamp, message in read_topic(bag, '/w0/joint_states')]
    assert full == [(k, k * 1e-9) for k in (0, 25_000_000, 50_000_000)] + [
        (k, k * 1e-9) for k in (15_000_000_000, 15_025_000_000, 15_050_000_000)
    ]
    assert [stamp for stamp, _ in read_topic(bag, 'joint_states')] == [stamp for stamp, _ in full]


def test_unknown_topic_names_the_known_ones(write_bag):
    with pytest.raises(BagError, match=r"'imu/data' expected, topics are /w0/episode_result"):
        next(read_topic(write_bag(), 'imu/data'))


def test_readers_do_not_import_ros(write_bag):
    # In a process of its own: this one has ROS for its samples.
    code = (
        'import sys; from hexapod_doe.bags.run_record import read_run; '
        f'read_run({str(write_bag())!r}); '
        "sys.exit('rclpy' in sys.modules or 'hexapod_interfaces' in sys.modules)"
    )
    subprocess.run([sys.executable, '-c', code], check=True)


def test_missing(tmp_path):
    with pytest.raises(BagError, match='nowhere: no such directory, expected a rosbag2 directory'):
        read_run(tmp_path / 'nowhere')


def test_unfinished(tmp_path, samples):
    writer = BagWriter(tmp_path / 'r1', {'run_id': 'r1'})
    samples.fill(writer, 1)
    with pytest.raises(BagError, match=r'not finished, .*r1\.partial is what there is'):
        read_run(tmp_path / 'r1')
    writer.abandon()


@pytest.mark.parametrize('size', [0, 1, 8, 100, 1000, -1, -40])
def test_cut_file(write_bag, size):
    bag = write_bag()
    file = bag / 'r1_0.mcap'
    whole = file.read_bytes()
    file.write_bytes(whole[:size])
    fault = 'empty' if size == 0 else 'cut short|not MCAP'
    with pytest.raises(BagError, match=rf'r1_0\.mcap is damaged \(({fault}).*expected a whole'):
        read_run(bag)
    assert not is_complete(bag)


def test_flipped_bit_in_a_chunk(write_bag):
    bag = write_bag(episodes=3, samples=0)
    file = bag / 'r1_0.mcap'
    whole = bytearray(file.read_bytes())
    position = whole.index(b'zstd') + 40
    whole[position] ^= 1
    file.write_bytes(whole)
    with pytest.raises(BagError, match=r'r1_0\.mcap is damaged'):
        read_run(bag)


def test_no_episode(tmp_path, samples):
    with BagWriter(tmp_path / 'r1', {'run_id': 'r1'}) as writer:
        writer.add_topic(samples.results)
    with pytest.raises(BagError, match='empty, expected at least one episode result'):
        read_run(tmp_path / 'r1')


def test_lost_file(write_bag):
    bag = write_bag()
    (bag / 'r1_0.mcap').unlink()
    with pytest.raises(BagError, match=r'r1_0\.mcap is missing'):
        read_run(bag)


def test_counts_that_disagree(write_bag):
    bag = write_bag(episodes=3, samples=4)
    listed = bag / 'metadata.yaml'
    listed.write_text(listed.read_text().replace('message_count: 12', 'message_count: 11'))
    with pytest.raises(BagError, match='holds 15 messages, expected 14'):
        read_run(bag)


def test_directory_of_something_else(tmp_path):
    with pytest.raises(BagError, match=r'no metadata\.yaml, expected a rosbag2 directory'):
        read_run(tmp_path)
    (tmp_path / 'metadata.yaml').write_text('a: 1')
    with pytest.raises(BagError, match=r'metadata\.yaml is not that of rosbag2'):
        read_run(tmp_path)


def foreign_bag(path, storage):
    """Write a bag by another library, with one std_msgs/String."""
    store = get_typestore(Stores.ROS2_JAZZY)
    text = store.types['std_msgs/msg/String']
    with Writer(path, version=9, storage_plugin=storage) as writer:
        connection = writer.add_connection('/chatter', 'std_msgs/msg/String', typestore=store)
        raw = store.serialize_cdr(text(data='hello'), 'std_msgs/msg/String')
        writer.write(connection, 5, raw)
    return path


def test_foreign_bag_is_no_run_but_its_topics_can_be_read(tmp_path):
    bag = foreign_bag(tmp_path / 'talk', StoragePlugin.MCAP)
    with pytest.raises(BagError, match='foreign, no metadata record hexapod_run'):
        read_run(bag)
    assert [(t, m.data) for t, m in read_topic(bag, '/chatter')] == [(5, 'hello')]


def test_other_storage(tmp_path):
    bag = foreign_bag(tmp_path / 'talk', StoragePlugin.SQLITE3)
    with pytest.raises(BagError, match=r"storage 'sqlite3', expected MCAP; cure: .ros2 bag"):
        read_run(bag)


def test_complete_means_status_and_every_episode(write_bag, tmp_path):
    assert is_complete(write_bag('whole'))
    assert not is_complete(write_bag('short', episodes=3, status='recording'))
    assert not is_complete(tmp_path / 'nowhere')


def test_an_evaluation_comes_back_apart_from_the_episodes(write_bag):
    bag = write_bag(evaluation=2)
    verify(bag)
    run = read_run(bag)
    assert list(run.evaluation['episode_return']) == [0.0, 10.0]
    assert len(run.episodes) == 3
    assert read_run(write_bag('plain')).evaluation.empty


def test_a_bag_that_lacks_a_part_of_its_evaluation_is_not_complete(write_bag, monkeypatch):
    bag = write_bag(evaluation=2)
    assert is_complete(bag)
    monkeypatch.setattr('hexapod_doe.bags.bag_state.evaluation_of', lambda metadata: 3)
    with pytest.raises(UnfinishedError, match='2 results of its evaluation, expected 3'):
        sound_metadata(bag)


def test_find_bags_leaves_out_what_is_unfinished(write_bag, tmp_path):
    write_bag('b')
    write_bag('a')
    for name in ('c.partial', 'c.cut_1', 'c.salvaged'):
        shutil.copytree(tmp_path / 'a', tmp_path / name)
    (tmp_path / 'deep').mkdir()
    shutil.copytree(tmp_path / 'a', tmp_path / 'deep' / 'd')
    assert find_bags(tmp_path) == [tmp_path / 'a', tmp_path / 'b', tmp_path / 'deep' / 'd']
    with pytest.raises(BagError, match='expected a folder with bags'):
        find_bags(tmp_path / 'nowhere')
