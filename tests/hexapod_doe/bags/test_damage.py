# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A bag that is damaged anywhere is read whole, or gives the one clear error; never another."""

import random

import pytest
from hexapod_doe.bags.bag_file import BagFile
from hexapod_doe.bags.bag_writer import BagWriter
from hexapod_doe.bags.rosbag2 import Topic
from hexapod_doe.errors import BagError

MESSAGES = 200


@pytest.fixture
def bag(tmp_path):
    """Write a bag of many chunks."""
    with BagWriter(tmp_path / 'b', {}, chunk_bytes=2000) as writer:
        writer.add_topic(Topic('/noise', 'std_msgs/msg/UInt64'))
        generator = random.Random(0)
        for k in range(MESSAGES):
            writer.write('/noise', b'\0\1\0\0' + generator.randbytes(8), k)
    return tmp_path / 'b'


@pytest.mark.parametrize('length', [0, 40, 1500])
def test_damage_is_an_error_of_the_bag_or_does_no_harm(bag, length):
    file = bag / 'b_0.mcap'
    good, generator = file.read_bytes(), random.Random(1)
    refused = 0
    for _ in range(150):
        damaged = bytearray(good)
        first = generator.randrange(len(good) - length)
        if length:
            damaged[first : first + length] = bytes(length)
        else:
            damaged[first] ^= 1 << generator.randrange(8)
        file.write_bytes(damaged)
        try:
            found = len(list(BagFile(bag).messages()))
        except BagError:
            refused += 1
        else:
            assert found == MESSAGES
    assert refused > 50
