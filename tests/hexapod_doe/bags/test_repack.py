# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A bag in fewer chunks says what it said."""

from pathlib import Path

import pytest
from hexapod_doe.bags.bag_file import BagFile
from hexapod_doe.bags.repack import repack
from hexapod_doe.bags.run_record import is_complete
from hexapod_doe.errors import BagError
from mcap.reader import make_reader
from mcap.records import Statistics


def _statistics(bag: Path) -> Statistics:
    with (bag / f'{bag.name}_0.mcap').open('rb') as stream:
        summary = make_reader(stream).get_summary()
    assert summary is not None
    assert summary.statistics is not None
    return summary.statistics


@pytest.mark.parametrize('samples', [0, 2], ids=['silent topic', 'sampled'])
def test_messages_times_topics_and_metadata_are_those_of_the_bag(tmp_path, write_bag, samples):
    bag = write_bag(episodes=30, samples=samples, evaluation=5, seed='7')
    copy = repack(bag, tmp_path / 'packed' / 'r1')
    old, new = BagFile(bag), BagFile(copy)
    assert list(new.messages()) == list(old.messages())
    assert new.run_metadata() == old.run_metadata()
    assert (new.types, new.counts, new.qos) == (old.types, old.counts, old.qos)
    assert is_complete(copy)
    assert is_complete(bag)
    assert _statistics(bag).chunk_count >= 30
    assert _statistics(copy).chunk_count == 1
    size, packed = ((each / 'r1_0.mcap').stat().st_size for each in (bag, copy))
    assert packed < 0.6 * size


def test_an_unfinished_run_is_not_packed(tmp_path, write_bag):
    bag = write_bag(status='aborted')
    with pytest.raises(BagError, match="status 'aborted'"):
        repack(bag, tmp_path / 'packed')
    assert not (tmp_path / 'packed').exists()


def test_what_is_there_already_stays(tmp_path, write_bag):
    bag, other = write_bag('r1'), write_bag('r2', gain=2.0)
    before = list(BagFile(other).messages())
    with pytest.raises(BagError, match='exists already'):
        repack(bag, other)
    assert list(BagFile(other).messages()) == before
