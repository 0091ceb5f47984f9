# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What is read from the bytes is what the message was given."""

import struct

import pytest
from hexapod_doe.bags.decoding import decompressed, is_cdr, stamp_ns
from zstandard import ZstdCompressor


def test_stamp_of_a_serialised_message(samples):
    for ns in (0, 25_000_000, 12_345_678_901_234_567):
        assert stamp_ns(samples.serialised_joints(ns % 2**31)) == ns % 2**31


def test_both_byte_orders():
    # sec = 3, nanosec = 7; the header's second byte is 1 for little endian, 0 for big endian.
    assert stamp_ns(struct.pack('<4BiI', 0, 1, 0, 0, 3, 7)) == 3_000_000_007
    assert stamp_ns(struct.pack('>4BiI', 0, 0, 0, 0, 3, 7)) == 3_000_000_007


def test_too_short():
    with pytest.raises(ValueError, match='11 bytes is too short to begin with a stamp'):
        stamp_ns(bytes(11))


def test_messages_begin_as_cdr_does(samples):
    assert is_cdr(samples.serialised_joints(5))
    assert not any(map(is_cdr, (b'', b'\0\1\0', b'{"a": 1}', b'\0\x07\0\0', b'\1\0\0\0')))


@pytest.mark.parametrize('sized', [True, False])
def test_a_compressed_message_comes_back_whole_or_not_at_all(samples, sized):
    message = samples.serialised_joints(5)
    assert decompressed(message) == message
    packed = ZstdCompressor(write_content_size=sized).compress(message)
    assert decompressed(packed) == message
    with pytest.raises(ValueError, match='cut short'):
        decompressed(packed[:-5])
