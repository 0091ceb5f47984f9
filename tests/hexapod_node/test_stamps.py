# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Stamps are whole nanoseconds on both sides of a message."""

from hexapod_node.stamps import duration_message, time_message, to_nanoseconds
from hypothesis import given
from hypothesis import strategies as st


@given(st.integers(0, 2**31 * 10**9 - 1))
def test_a_stamp_survives_the_message(nanoseconds: int) -> None:
    assert to_nanoseconds(time_message(nanoseconds)) == nanoseconds
    assert to_nanoseconds(duration_message(nanoseconds)) == nanoseconds


def test_a_control_period_is_25_million_nanoseconds() -> None:
    stamp = time_message(40 * 25_000_000 + 25_000_000)
    assert (stamp.sec, stamp.nanosec) == (1, 25_000_000)
