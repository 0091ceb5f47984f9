# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Ticks stay on their grid, and each one that was due is served late or counted as missed."""

from __future__ import annotations

from hexapod_node.ticker import Due, Schedule
from hypothesis import given
from hypothesis import strategies as st

PERIOD = 25


def test_a_tick_is_as_late_as_the_grid_says() -> None:
    schedule = Schedule(PERIOD, 100)
    assert schedule.serve(99) is None
    assert schedule.serve(100) == Due(0, 0)
    assert schedule.serve(101) is None  # the next one is due at 125
    assert schedule.serve(128) == Due(3, 0)
    assert schedule.serve(150) == Due(0, 0)


def test_what_was_due_meanwhile_is_missed() -> None:
    schedule = Schedule(PERIOD, 100)
    assert schedule.serve(180) == Due(80, 3)  # 100 is served; 125, 150 and 175 are not
    assert schedule.serve(200) == Due(0, 0)


def test_a_clock_that_goes_back_begins_a_new_grid() -> None:
    schedule = Schedule(PERIOD, None)
    assert schedule.serve(10_000) == Due(0, 0)
    assert schedule.serve(40) == Due(0, 0)
    assert schedule.serve(65) == Due(0, 0)


@given(st.lists(st.integers(0, 200), min_size=1, max_size=60))
def test_every_due_tick_is_served_or_missed(waits: list[int]) -> None:
    schedule = Schedule(PERIOD, 0)
    now = served = missed = 0
    for wait in waits:
        now += wait
        due = schedule.serve(now)
        if due is not None:
            served += 1
            missed += due.missed
    assert served + missed == now // PERIOD + 1 or not served
    assert schedule.serve(now) is None or not served
