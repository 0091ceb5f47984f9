# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What a killed recording held up to its last whole chunk comes back."""

import subprocess
import sys

import pytest
from hexapod_doe.bags.bag_writer import BagWriter
from hexapod_doe.bags.rosbag2 import partial_path
from hexapod_doe.bags.run_record import find_bags, is_complete, read_run
from hexapod_doe.bags.salvage import salvage, set_aside
from hexapod_doe.bags.verify import digest
from hexapod_doe.errors import BagError
from rosbags.highlevel import AnyReader

# Records episodes without end; each is flushed, then announced.
RECORD_FOR_EVER = """
import itertools, sys
from pathlib import Path
from hexapod_doe.bags.bag_writer import BagWriter
from hexapod_doe.bags.rosbag2 import Topic
writer = BagWriter(Path(sys.argv[1]), {'run_id': 'r1', 'seed': '7'})
writer.add_topic(Topic('/w0/episode_result', 'hexapod_interfaces/msg/EpisodeResult'))
data = bytes.fromhex(sys.argv[2])
for k in itertools.count():
    writer.write('/w0/episode_result', data, k)
    writer.flush()
    print(k, flush=True)
"""


def test_killed_recording_is_salvaged_to_the_last_flushed_chunk(tmp_path, samples):
    bag = tmp_path / 'r1'
    data = samples.serialised_result(0).hex()
    process = subprocess.Popen(
        [sys.executable, '-c', RECORD_FOR_EVER, str(bag), data], stdout=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    announced = [process.stdout.readline() for _ in range(50)]
    with pytest.raises(BagError, match=r'r1\.partial is still being written'):
        salvage(bag)
    process.kill()
    announced += process.stdout.read().splitlines()
    process.wait()

    salvaged = salvage(bag)
    assert salvaged == tmp_path / 'r1.salvaged'
    with AnyReader([salvaged]) as reader:
        times = [stamp for _, stamp, _ in reader.messages()]
    # What was announced was flushed; one more may have been flushed and not announced.
    assert times == list(range(len(times)))
    assert len(times) in (len(announced), len(announced) + 1)
    run = read_run(salvaged)
    expected = {'run_id': 'r1', 'seed': '7', 'status': 'salvaged', 'digest': digest(salvaged)}
    assert run.metadata == expected
    assert not is_complete(salvaged)
    assert find_bags(tmp_path) == []


@pytest.fixture
def cut(tmp_path, samples):
    """An unfinished bag of 20 episodes, each in its chunk, and the bytes of its file."""
    writer = BagWriter(tmp_path / 'r1', {'run_id': 'r1'})
    samples.fill(writer, 20, samples=3)
    partial = writer.abandon()
    return partial / 'r1_0.mcap', (partial / 'r1_0.mcap').read_bytes()


@pytest.mark.parametrize('share', [0.2, 0.3, 0.4, 0.4004, 0.5])
def test_cut_anywhere(cut, tmp_path, share):
    file, whole = cut
    file.write_bytes(whole[: int(share * len(whole))])
    with AnyReader([salvage(tmp_path / 'r1')]) as reader:
        messages = [(c.topic, stamp) for c, stamp, _ in reader.messages()]
    # Whole episodes: three joint states and a result each.
    assert len(messages) % 4 == 0
    assert 0 < len(messages) < 80


def test_damage_in_the_middle_ends_the_salvage_there(cut, tmp_path):
    file, whole = cut
    half = len(whole) // 2
    file.write_bytes(whole[:half] + b'\0' * 64 + whole[half + 64 :])
    with AnyReader([salvage(tmp_path / 'r1')]) as reader:
        assert 0 < reader.message_count < 80


def test_nothing_to_salvage(cut, tmp_path):
    file, whole = cut
    file.write_bytes(whole[:100])
    with pytest.raises(BagError, match='nothing to salvage, expected at least one whole chunk'):
        salvage(tmp_path / 'r1')
    file.unlink()
    with pytest.raises(BagError, match='expected an unfinished recording'):
        salvage(tmp_path / 'r1')


def test_set_aside_keeps_every_cut(tmp_path, samples):
    bag = tmp_path / 'r1'
    assert set_aside(bag) is None
    for n in (1, 2):
        writer = BagWriter(bag, {})
        with pytest.raises(BagError, match='is still being written'):
            set_aside(bag)
        samples.fill(writer, n)
        writer.abandon()
        assert set_aside(bag) == tmp_path / f'r1.cut_{n}'
    assert not partial_path(bag).exists()


def test_takeover_sets_aside_what_is_still_being_written(tmp_path, samples):
    bag = tmp_path / 'r1'
    slow = BagWriter(bag, {})
    samples.fill(slow, 1)
    assert set_aside(bag, takeover=True) == tmp_path / 'r1.cut_1'
    with BagWriter(bag, {'run_id': 'r1', 'status': 'complete', 'episodes': '2'}) as quick:
        samples.fill(quick, 1)
        for end in (slow.flush, slow.close):
            with pytest.raises(BagError, match=r'taken the run over|earlier write failed'):
                end()
        samples.fill(quick, 1)
    assert is_complete(bag)
    assert sorted(path.name for path in tmp_path.iterdir()) == ['r1', 'r1.cut_1']


def test_set_aside_takes_a_damaged_bag_but_no_complete_one(write_bag):
    bag = write_bag('r1')
    assert set_aside(bag) is None
    (bag / 'metadata.yaml').unlink()
    assert set_aside(bag) == bag.with_name('r1.cut_1')
    assert not bag.exists()


def test_set_aside_leaves_a_directory_of_something_else(tmp_path):
    (tmp_path / 'home').mkdir()
    (tmp_path / 'home' / 'thesis.txt').write_text('dear')
    assert set_aside(tmp_path / 'home') is None
    assert (tmp_path / 'home' / 'thesis.txt').exists()
