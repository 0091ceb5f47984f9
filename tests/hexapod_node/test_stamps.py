# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Stamps are whole nanoseconds on both sides of a message."""

import pytest
from builtin_interfaces.msg import Time
from hexapod_node.stamps import (
    duration_message,
    requested_start_ns,
    time_message,
    to_nanoseconds,
)
from hypothesis import given
from hypothesis import strategies as st


@given(st.integers(0, 2**31 * 10**9 - 1))
def test_a_stamp_survives_the_message(nanoseconds: int) -> None:
    assert to_nanoseconds(time_message(nanoseconds)) == nanoseconds
    assert to_nanoseconds(duration_message(nanoseconds)) == nanoseconds


def test_a_control_period_is_25_million_nanoseconds() -> None:
    stamp = time_message(40 * 25_000_000 + 25_000_000)
    assert (stamp.sec, stamp.nanosec) == (1, 25_000_000)


@pytest.mark.parametrize('seconds', [2**31, -(2**31) - 1, 2**63])
def test_what_no_stamp_reaches_is_refused(seconds: int) -> None:
    with pytest.raises(ValueError, match=f'time {seconds} s: out of the range of stamps'):
        time_message(seconds * 1_000_000_000)


@pytest.mark.parametrize(('seconds', 'fits'), [(0, True), (-1, False), (2**31 - 1, False)])
def test_a_start_leaves_room_for_episodes(seconds: int, fits: bool) -> None:
    if fits:
        assert requested_start_ns(Time(sec=seconds, nanosec=7)) == seconds * 10**9 + 7
        return
    with pytest.raises(ValueError, match=f'start {seconds} s: expected 0 to '):
        requested_start_ns(Time(sec=seconds))
