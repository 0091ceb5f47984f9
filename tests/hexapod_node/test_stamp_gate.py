# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A period is complete when every topic has delivered it; everything else is counted."""

from hexapod_node.stamp_gate import DuePeriod, LockStepCounts, StampGate
from hypothesis import given
from hypothesis import strategies as st

PERIOD = 25


def test_a_period_is_complete_when_every_topic_has_delivered_it() -> None:
    gate = StampGate(['a', 'b'], PERIOD)
    gate.start(100)
    assert not gate.offer('a', 100, 'a100')
    assert gate.absent() == ['b']
    assert gate.offer('b', 100, 'b100')
    assert gate.take() == {'a': 'a100', 'b': 'b100'}
    assert gate.expected_ns == 125
    assert gate.counts == LockStepCounts()


def test_what_comes_before_the_start_is_known_is_kept() -> None:
    gate = StampGate(['a', 'b'], PERIOD)
    gate.offer('a', 75, 'of the last episode')
    gate.offer('a', 100, 'a100')
    gate.offer('b', 100, 'b100')
    assert not gate.complete
    gate.start(100)
    assert gate.complete
    assert gate.take() == {'a': 'a100', 'b': 'b100'}
    assert gate.counts == LockStepCounts()


def test_each_departure_is_counted_once() -> None:
    gate = StampGate(['a', 'b'], PERIOD)
    gate.start(100)
    gate.offer('a', 75, 'late')
    gate.offer('a', 100, 'first')
    gate.offer('a', 100, 'second')
    gate.offer('b', 125, 'early')
    assert gate.counts == LockStepCounts(late=1, duplicate=1, out_of_order=1)
    gate.offer('b', 100, 'b100')
    assert gate.take() == {'a': 'first', 'b': 'b100'}
    assert gate.offer('a', 125, 'a125'), 'the early sample waited for its turn'


@given(st.permutations([(topic, stamp) for topic in 'abc' for stamp in range(0, 100, PERIOD)]))
def test_any_order_of_arrival_gives_every_period_whole(order: list[tuple[str, int]]) -> None:
    gate = StampGate('abc', PERIOD)
    gate.start(0)
    taken = []
    for topic, stamp in order:
        gate.offer(topic, stamp, stamp)
        while gate.complete:
            taken.append(gate.take())
    assert taken == [dict.fromkeys('abc', stamp) for stamp in range(0, 100, PERIOD)]
    assert gate.counts.late == gate.counts.duplicate == 0


def test_only_the_message_that_is_due_is_admitted() -> None:
    due = DuePeriod(PERIOD)
    assert not due.admit(0)
    due.start(100)
    assert [due.admit(stamp) for stamp in (100, 75, 50, 125)] == [True, False, False, False]
    assert due.counts == LockStepCounts(duplicate=1, late=1, out_of_order=2)
    due.stop()
    assert not due.admit(100)


def test_wrong_stamps_fill_no_memory_and_cost_no_period() -> None:
    gate = StampGate(['a'], PERIOD)
    for stamp in range(10_000):
        gate.offer('a', 1_000_000 + stamp, 'hostile')
    gate.offer('a', 100, 'a100')
    gate.start(100)
    for stamp in range(10_000):
        gate.offer('a', 2_000_000 + stamp, 'hostile')
    gate.offer('a', 125, 'a125')
    assert len(gate._waiting) <= 64
    assert [gate.take(), gate.take()] == [{'a': 'a100'}, {'a': 'a125'}]
