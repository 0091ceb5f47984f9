# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A written bag is a rosbag2 directory for independent readers, and never half of one."""

import os
import resource
from contextlib import contextmanager

import pytest
import yaml
from hexapod_doe.bags.bag_writer import BagWriter
from hexapod_doe.bags.rosbag2 import OfferedQos, Topic, offered_qos
from hexapod_doe.errors import BagError
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from rosbags.highlevel import AnyReader
from rosbags.rosbag2 import Reader


def test_rosbags_counts_and_decodes_every_message(write_bag, samples):
    bag = write_bag(episodes=3, samples=5)
    listed = yaml.safe_load((bag / 'metadata.yaml').read_text())['rosbag2_bagfile_information']
    with Reader(bag) as reader:
        assert reader.message_count == listed['message_count'] == 3 * 5 + 3
        assert {c.topic: c.msgcount for c in reader.connections} == {
            samples.joints.name: 15,
            samples.results.name: 3,
        }
        assert all(c.digest.startswith('RIHS01_') for c in reader.connections)
    with AnyReader([bag]) as reader:
        decoded = [reader.deserialize(raw, c.msgtype) for c, _, raw in reader.messages()]
    assert len(decoded) == 18
    assert [m.episode for m in decoded if hasattr(m, 'episode')] == [0, 1, 2]


def test_hashes_are_those_of_the_definitions_in_the_bag(write_bag):
    # rosbags computes the RIHS01 hash of REP 2016 from the text that the bag carries.
    with AnyReader([write_bag()]) as reader:
        for connection in reader.connections:
            assert reader.typestore.hash_rihs01(connection.msgtype) == connection.digest


def test_file_is_indexed_compressed_and_of_profile_ros2(write_bag):
    bag = write_bag()
    with (bag / 'r1_0.mcap').open('rb') as stream:
        reader = make_reader(stream, validate_crcs=True, decoder_factories=[DecoderFactory()])
        assert reader.get_header().profile == 'ros2'
        summary = reader.get_summary()
        assert {index.compression for index in summary.chunk_indexes} == {'zstd'}
        assert summary.statistics.message_count == 15
        decoded = [item.decoded_message for item in reader.iter_decoded_messages()]
    assert decoded[1].position[0] == 0.025
    assert list(decoded[4].term_names) == ['progress', 'effort']


def test_channel_offers_what_metadata_yaml_offers(tmp_path):
    offered = (OfferedQos(reliability='best_effort', depth=5), OfferedQos())
    with BagWriter(tmp_path / 'b', {}) as writer:
        writer.add_topic(Topic('/imu', 'sensor_msgs/msg/Imu', offered))
    listed = yaml.safe_load((tmp_path / 'b/metadata.yaml').read_text())
    topic = listed['rosbag2_bagfile_information']['topics_with_message_count'][0]
    with (tmp_path / 'b/b_0.mcap').open('rb') as stream:
        (channel,) = make_reader(stream).get_summary().channels.values()
    in_channel = yaml.safe_load(channel.metadata['offered_qos_profiles'])
    assert in_channel == topic['topic_metadata']['offered_qos_profiles']
    assert offered_qos(in_channel) == offered


def test_bag_has_its_name_only_when_it_is_whole(tmp_path, samples):
    writer = BagWriter(tmp_path / 'r1', {'run_id': 'r1'})
    samples.fill(writer, 2)
    assert os.listdir(tmp_path) == ['r1.partial']
    assert writer.close() == tmp_path / 'r1'
    assert os.listdir(tmp_path) == ['r1']


def test_abandoned_bag_is_readable_under_its_unfinished_name(tmp_path, samples):
    writer = BagWriter(tmp_path / 'r1', {})
    samples.fill(writer, 2)
    writer.__exit__(RuntimeError, RuntimeError(), None)
    with Reader(tmp_path / 'r1.partial') as reader:
        assert reader.message_count == 2


def test_nothing_is_overwritten(write_bag, tmp_path):
    bag = write_bag()
    with pytest.raises(BagError, match='exists already, expected a new directory'):
        BagWriter(bag, {})
    writer = BagWriter(tmp_path / 'other', {})
    with pytest.raises(BagError, match=r'other\.partial is being written'):
        BagWriter(tmp_path / 'other', {})
    writer.abandon()


def test_closed_writer_refuses(tmp_path, samples):
    writer = BagWriter(tmp_path / 'r1', {})
    samples.fill(writer, 1)
    writer.close()
    with pytest.raises(BagError, match='it is closed'):
        writer.write(samples.results.name, b'', 0)


def test_topic_keeps_its_type(tmp_path, samples):
    with BagWriter(tmp_path / 'r1', {}) as writer:
        writer.add_topic(samples.joints)
        writer.add_topic(samples.joints)
        with pytest.raises(BagError, match='expected sensor_msgs/msg/JointState as before'):
            writer.add_topic(Topic(samples.joints.name, samples.results.type_name))


@contextmanager
def full_disk():
    """Let files grow to 20 kB: the kernel refuses the rest, as it does when a disk is full.

    Only around the writes: pytest's own output may be a longer file.
    """
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


def test_full_disk_is_one_clear_error_and_loses_no_whole_chunk(tmp_path, samples):
    writer = BagWriter(tmp_path / 'r1', {'run_id': 'r1'})
    refused = r'r1: cannot write: File too large; the \d+ messages'
    with full_disk(), pytest.raises(BagError, match=refused):
        samples.fill(writer, 1000)
    recorded = writer.extent.messages
    with pytest.raises(BagError, match='an earlier write failed'):
        writer.flush()
    assert writer.abandon() == tmp_path / 'r1.partial'
    assert 10 < recorded < 1000
    assert os.listdir(tmp_path) == ['r1.partial']


def test_read_only_folder_is_one_clear_error(tmp_path):
    (tmp_path / 'file').write_text('')
    with pytest.raises(BagError, match=r'cannot write: .*file'):
        BagWriter(tmp_path / 'file' / 'r1', {})
