# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The newest good sample serves until it is too old; every other one is dropped and counted."""

from __future__ import annotations

import pytest
from hexapod_node.invalid_message import InvalidMessageError
from hexapod_node.sample_gate import FUTURE_NS, SampleGate
from hypothesis import given
from hypothesis import strategies as st

AGE = 100_000_000
NOW = 10_000_000_000


def decode(message: str) -> str:
    if message == 'short':
        raise InvalidMessageError('wrong_length', 'joints: 17 numbers, expected 18')
    if message == 'odd':
        raise ValueError('joints: odd')
    return message.upper()


@pytest.fixture
def gate() -> SampleGate[str]:
    made = SampleGate('joints', AGE, decode)
    assert made.value(NOW) is None
    assert made.fault(NOW) == 'joints: no good sample yet'
    return made


def test_a_sample_serves_until_it_is_too_old(gate: SampleGate[str]) -> None:
    assert gate.offer('a', NOW - 5, NOW)
    assert gate.value(NOW) == 'A'
    assert gate.age_ns(NOW) == 5
    assert gate.value(NOW - 5 + AGE) == 'A'
    assert gate.value(NOW - 4 + AGE) is None
    assert gate.fault(NOW + 2 * AGE) == (
        'joints: newest good sample is 0.200 s old, expected at most 0.1 s'
    )


@pytest.mark.parametrize(
    ('stamp', 'count', 'text'),
    [
        (NOW - AGE - 1, 'stale', 'header.stamp is 0.100 s old'),
        (NOW + FUTURE_NS + 1, 'future', 'header.stamp is 0.050 s in the future'),
        (NOW - 1_000_000, 'out_of_order', 'header.stamp went back by 0.001 s'),
        (NOW, 'duplicate', 'header.stamp is that of the sample before'),
    ],
)
def test_a_stamp_at_fault_is_counted_by_its_kind(
    gate: SampleGate[str], stamp: int, count: str, text: str
) -> None:
    gate.offer('a', NOW, NOW)
    assert not gate.offer('b', stamp, NOW)
    assert gate.value(NOW) == 'A'
    assert getattr(gate.counts, count) == gate.counts.faults == 1
    assert gate.reason == f'joints: {text}'


def test_a_bad_sample_is_counted_by_its_kind_and_told(gate: SampleGate[str]) -> None:
    gate.offer('a', NOW, NOW)
    gate.offer('short', NOW + 1, NOW + 1)
    gate.offer('odd', NOW + 2, NOW + 2)
    assert gate.value(NOW + 2) == 'A'
    assert gate.counts.invalid == 2
    assert gate.kinds == {'wrong_length': 1, 'unusable': 1}
    assert gate.fault(NOW + AGE + 1).endswith('the last bad one: joints: odd')


def test_a_clock_that_jumps_holds_nobody_up_for_longer_than_an_age(gate: SampleGate[str]) -> None:
    gate.offer('a', NOW, NOW)
    earlier = NOW - 3600 * 1_000_000_000
    assert gate.offer('b', earlier, earlier)
    assert gate.value(earlier) == 'B'


@given(st.lists(st.tuples(st.integers(-300, 300), st.integers(0, 50)), max_size=50))
def test_a_value_is_never_too_old_and_every_sample_is_accounted_for(
    samples: list[tuple[int, int]],
) -> None:
    gate: SampleGate[str] = SampleGate('joints', AGE, decode)
    now, accepted = NOW, 0
    for ahead_ms, wait_ms in samples:
        now += wait_ms * 1_000_000
        accepted += gate.offer('a', now + ahead_ms * 1_000_000, now)
        if gate.value(now) is not None:
            assert -FUTURE_NS <= gate.age_ns(now) <= AGE
    assert gate.counts.received == len(samples)
    assert gate.counts.accepted == accepted


def test_a_further_publisher_is_counted_and_not_heard_while_the_first_one_speaks(
    gate: SampleGate[str],
) -> None:
    assert gate.offer('a', NOW, NOW, sequence=70)
    assert gate.contest(NOW) == ''
    assert not gate.offer('b', NOW + 1, NOW + 1, sequence=3)
    assert gate.offer('a', NOW + 2, NOW + 2, sequence=73)  # two were lost on their way
    assert not gate.offer('b', NOW + 3, NOW + 3, sequence=4)
    assert gate.value(NOW + 3) == 'A'
    assert gate.counts.other_publisher == gate.counts.faults == 2
    assert 'joints: has more than one publisher' in gate.contest(NOW + 3)
    assert gate.contest(NOW + 3_000_000_000) == ''


def test_a_publisher_that_fell_silent_is_followed_by_the_next_one_with_a_good_sample(
    gate: SampleGate[str],
) -> None:
    gate.offer('a', NOW, NOW, sequence=70)
    later = NOW + AGE + 1
    assert not gate.offer('odd', later, later, sequence=5)
    assert gate.offer('c', later, later, sequence=2)
    assert not gate.offer('odd', later + 1, later + 1, sequence=6 + 1000)
    assert gate.value(later + 1) == 'C'


def test_a_bad_sample_of_the_first_publisher_is_still_the_first_ones(
    gate: SampleGate[str],
) -> None:
    gate.offer('a', NOW, NOW, sequence=70)
    for lost in range(200):
        assert not gate.offer('odd', NOW + 1 + lost, NOW + 1, sequence=71 + lost)
    assert gate.offer('a', NOW + 500, NOW + 500, sequence=271)
    assert gate.counts.other_publisher == 0


def test_where_the_middleware_numbers_nothing_everything_is_heard(gate: SampleGate[str]) -> None:
    assert gate.offer('a', NOW, NOW)
    assert gate.offer('b', NOW + 1, NOW + 1)
    assert gate.counts.other_publisher == 0
