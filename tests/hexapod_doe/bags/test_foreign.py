# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Bags as other programs leave them: read, or refused in one line that says what to do."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml
from hexapod_doe.bags.bag_file import BagFile
from hexapod_doe.bags.bag_state import find_bags
from hexapod_doe.bags.run_record import read_run, read_topic
from hexapod_doe.errors import BagError
from hexapod_doe.replays.rescoring import rescore
from hexapod_sim.article import section
from hexapod_sim.task_config import TaskConfig
from mcap.writer import CompressionType, Writer

from .conftest import HELLO, Recorded, write_file

CASES = Path(__file__).resolve().parents[2] / 'data/cases'
PLAIN = CASES / 'plain_ok'


def complaint(path: Path | str, topic: str = '/chatter') -> str:
    """Return the one line with which a bag is refused."""
    with pytest.raises(BagError) as caught:
        list(BagFile(path).decoded(topic))
    text = str(caught.value)
    assert '\n' not in text
    assert len(text) < 500
    return text


@pytest.mark.parametrize('case', ['b02_file_zstd', 'b03_message_zstd', 'plain_ok'])
def test_compression_outside_mcap_is_undone(case: str) -> None:
    values = [
        message.offset for _, message in BagFile(CASES / case).decoded('/hexapod/line_offset')
    ]
    plain = [message.offset for _, message in BagFile(PLAIN).decoded('/hexapod/line_offset')]
    assert values == plain[: len(values)]
    assert len(values) >= 8


@pytest.mark.parametrize(
    'file', ['plain_ok/plain_0.mcap', 'b02_file_zstd/b02_file_zstd_0.mcap.zstd']
)
def test_one_file_is_read_by_itself(file: str) -> None:
    bare, whole = BagFile(CASES / file), BagFile(PLAIN)
    assert (bare.types, bare.counts, bare.start_ns) == (whole.types, whole.counts, whole.start_ns)
    assert list(bare.messages()) == list(whole.messages())
    assert bare.about.duration_ns == whole.about.duration_ns
    assert find_bags(CASES / file) == [CASES / file]


def test_a_file_without_a_summary_is_read_by_itself(tmp_path: Path) -> None:
    write_file(tmp_path / 'x.mcap', [Recorded(messages=[(3, HELLO), (9, HELLO)])], indexed=False)
    bag = BagFile(tmp_path / 'x.mcap')
    assert (bag.counts, bag.start_ns, bag.about.duration_ns) == ({'/chatter': 2}, 3, 6)
    assert [message.data for _, message in bag.decoded('/chatter')] == ['hello', 'hello']


def test_the_home_directory_and_the_metadata_file_lead_to_the_bag(monkeypatch) -> None:
    monkeypatch.setenv('HOME', str(CASES))
    assert BagFile('~/plain_ok').path == PLAIN
    assert BagFile(PLAIN / 'metadata.yaml').path == PLAIN
    assert len(find_bags('~/plain_ok')) == 1


def test_a_folder_of_bags_is_told_from_a_bag(tmp_path: Path) -> None:
    text = complaint(CASES)
    assert 'is a folder with 11 bags below it' in text
    assert f'cure: give {CASES / "b01_write_split"}' in text
    (tmp_path / 'notes.txt').write_text('x')
    assert 'no metadata.yaml' in complaint(tmp_path)
    assert 'is a file, expected a rosbag2 directory' in complaint(tmp_path / 'notes.txt')
    with pytest.raises(BagError, match='is a file, expected a folder with bags'):
        find_bags(tmp_path / 'notes.txt')


def test_a_folder_without_metadata_names_its_files(foreign) -> None:
    bag = foreign(Recorded())
    (bag / 'metadata.yaml').unlink()
    text = complaint(bag)
    assert f'cure: give {bag / "foreign_0.mcap"}, or `ros2 bag reindex` it' in text
    assert next(iter(read_topic(bag / 'foreign_0.mcap', 'chatter')))[1].data == 'hello'


def test_a_file_of_sqlite_names_the_conversion(tmp_path: Path) -> None:
    (tmp_path / 'x.db3').write_bytes(b'SQLite format 3\0')
    text = complaint(tmp_path / 'x.db3')
    assert "storage 'db3'" in text
    assert 'ros2 bag convert' in text


@pytest.mark.parametrize(
    ('changes', 'reason'),
    [
        ({'storage_identifier': 'sqlite3'}, "storage 'sqlite3'"),
        (
            {'compression_mode': 'MESSAGE', 'compression_format': 'lz4'},
            "compressed with 'lz4', expected zstd",
        ),
        (
            {'relative_file_paths': ['foreign_0.mcap', 'foreign_1.mcap']},
            'foreign_1.mcap is missing',
        ),
        ({'topics_with_message_count': None}, 'metadata.yaml has an odd entry'),
        ({'starting_time': {}}, "metadata.yaml lacks 'nanoseconds_since_epoch'"),
        ({'duration': {'nanoseconds': 'x'}}, 'metadata.yaml has an odd entry'),
        ({'message_count': 3, 'starting_time': {}, 'version': 12}, 'version 12, newer than 9'),
    ],
)
def test_metadata_that_does_not_fit_is_named(foreign, changes: dict, reason: str) -> None:
    assert reason in complaint(foreign(Recorded(), **changes))


def test_a_newer_version_is_read_as_far_as_it_is_known(foreign) -> None:
    bag = BagFile(foreign(Recorded(), version=11, brand_new={'a': 1}))
    assert len(list(bag.messages())) == 1


@pytest.mark.parametrize('profiles', ['- {x: 1}', '[', '- history: 1', [{'depth': 1}], 7])
def test_odd_quality_of_service_is_one_line(foreign, profiles: object) -> None:
    bag = foreign(Recorded())
    file = bag / 'metadata.yaml'
    content = yaml.safe_load(file.read_text())
    (topic,) = content['rosbag2_bagfile_information']['topics_with_message_count']
    topic['topic_metadata']['offered_qos_profiles'] = profiles
    file.write_text(yaml.safe_dump(content))
    assert 'metadata.yaml' in complaint(bag)


@pytest.mark.parametrize(
    ('recorded', 'reason'),
    [
        (Recorded(definition=b'\xff\xfe\xfd'), 'its definition cannot be understood'),
        (Recorded(definition=b'no field at all ='), 'its definition cannot be understood'),
        (Recorded(language='ros2idl'), 'defined in ros2idl'),
        (Recorded(encoding='json'), 'messages in json'),
        (Recorded(messages=[(1, b'')]), 'the message of 1 ns cannot be decoded'),
        (Recorded(messages=[(1, b'\0\1\0\0\1')]), 'cannot be decoded'),
        (Recorded(messages=[(1, b'\x28\xb5\x2f\xfd\x60')]), 'cannot be decoded'),
    ],
)
def test_what_cannot_be_decoded_is_one_line(foreign, recorded: Recorded, reason: str) -> None:
    assert reason in complaint(foreign(recorded))


def test_idl_is_named(tmp_path: Path) -> None:
    with pytest.raises(BagError, match='LateralCommand cannot be decoded: defined in ros2idl'):
        next(read_topic(CASES / 'b06_idl', 'control/lateral'))


def test_an_unknown_compression_of_chunks_is_named(foreign) -> None:
    bag = foreign(Recorded())
    file = bag / 'foreign_0.mcap'
    with file.open('wb') as stream:
        writer = Writer(stream, compression=CompressionType.LZ4)
        writer.start()
        schema = writer.register_schema('std_msgs/msg/String', 'ros2msg', b'string data')
        writer.add_message(writer.register_channel('/chatter', 'cdr', schema), 5, HELLO, 5)
        writer.finish()
    assert len(list(BagFile(bag).messages())) == 1
    file.write_bytes(file.read_bytes().replace(b'\3\0\0\0lz4', b'\3\0\0\0lzo'))
    assert 'unsupported compression type lzo' in complaint(bag)


def test_two_robots_are_there_twice() -> None:
    bag = BagFile(CASES / 'b05_two_robots')
    with pytest.raises(BagError, match=r'is there twice: /robot1/.*, /robot2/.*; choose'):
        bag.topic('imu/data')
    assert bag.topic('robot1/imu/data') == '/robot1/imu/data'


def test_an_empty_bag_is_no_run(foreign) -> None:
    with pytest.raises(BagError, match='expected the bag of a run'):
        read_run(foreign(Recorded(messages=())))


def test_a_topic_of_another_type_is_not_read_for_the_one_that_is_meant(foreign) -> None:
    bag = foreign(Recorded('/robot/odom'))
    with pytest.raises(BagError, match='/robot/odom is of type std_msgs/msg/String'):
        next(read_topic(bag, 'odom', 'nav_msgs/msg/Odometry'))
    with pytest.raises(BagError, match='is of type std_msgs/msg/String, expected nav_msgs'):
        next(rescore(BagFile(bag), TaskConfig(**section('task'))))
