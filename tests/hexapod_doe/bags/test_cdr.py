# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Stamps read from the bytes are those that the message was given."""

import struct

import pytest
from hexapod_doe.bags.cdr import stamp_ns


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
