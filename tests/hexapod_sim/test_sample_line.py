# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Samples come late, at another rate or not at all, as asked; held ones fill every period."""

from __future__ import annotations

from itertools import pairwise

import pytest
from hexapod_sim.sample_line import SampleLine, Timing
from hypothesis import given, settings
from hypothesis import strategies as st

PERIOD = 25_000_000
STAMPS = [1_000_000_000 + PERIOD * step for step in range(400)]


def delivered(timing: Timing, seed: int = 1, stamps=STAMPS) -> list[list[tuple[int, int]]]:
    """Return what each sample of the source makes come; an item is its own stamp."""
    line: SampleLine[int] = SampleLine(timing, seed)
    return [line.offer(stamp, stamp) for stamp in stamps]


def flat(found: list[list[tuple[int, int]]]) -> list[tuple[int, int]]:
    return [entry for entries in found for entry in entries]


def test_a_perfect_line_delivers_every_sample_at_once() -> None:
    assert delivered(Timing()) == [[(stamp, stamp)] for stamp in STAMPS]


@pytest.mark.parametrize(('delay', 'periods'), [(0.025, 1), (0.05, 2), (0.06, 3)])
def test_a_delayed_sample_keeps_its_stamp(delay: float, periods: int) -> None:
    found = delivered(Timing(delay=delay))
    assert found[:periods] == [[]] * periods
    assert flat(found) == [(stamp, stamp) for stamp in STAMPS[:-periods]]


@settings(max_examples=20)
@given(st.floats(0.0, 0.9), st.integers(0, 2**63 - 1))
def test_the_share_of_lost_samples_is_the_dropout(dropout: float, seed: int) -> None:
    line: SampleLine[int] = SampleLine(Timing(dropout=dropout), seed)
    came = flat([line.offer(stamp, stamp) for stamp in STAMPS])
    assert line.lost + len(came) == len(STAMPS)
    # Five standard errors of a share of 400 are at most 0.125.
    assert line.lost / len(STAMPS) == pytest.approx(dropout, abs=0.125)
    assert came == flat(delivered(Timing(dropout=dropout), seed))


@pytest.mark.parametrize(('rate', 'count'), [(40.0, 400), (20.0, 200), (30.0, 300), (4.0, 40)])
def test_a_lower_rate_leaves_samples_out_evenly(rate: float, count: int) -> None:
    came = [stamp for stamp, _ in flat(delivered(Timing(rate=rate)))]
    assert abs(len(came) - count) <= 1
    steps = [(b - a) // PERIOD for a, b in pairwise(came)]
    assert max(steps) - min(steps) <= 1


def test_a_source_that_starts_again_is_followed() -> None:
    again = [*STAMPS, *STAMPS[:40]]
    came = flat(delivered(Timing(rate=20.0), stamps=again))
    assert len(came) == 220


@settings(max_examples=30)
@given(
    st.floats(0.0, 0.2), st.floats(0.0, 0.8), st.sampled_from([0.0, 10.0, 20.0]), st.integers(0, 9)
)
def test_holding_fills_every_period_with_the_newest_that_arrived(
    delay: float, dropout: float, rate: float, seed: int
) -> None:
    held = delivered(Timing(delay, dropout, rate, hold=True), seed)
    plain = delivered(Timing(delay, dropout, rate), seed)
    newest = STAMPS[0]
    for stamp, given_out, arrived in zip(STAMPS, held, plain, strict=True):
        newest = arrived[-1][1] if arrived else newest
        assert given_out == [(stamp, newest)]


@pytest.mark.parametrize('wrong', [{'delay': -1.0}, {'dropout': 1.0}, {'rate': -1.0}])
def test_what_no_device_does_is_refused(wrong: dict[str, float]) -> None:
    with pytest.raises(ValueError, match='expected none negative'):
        Timing(**wrong)


def test_a_stamp_of_the_future_holds_nobody_up() -> None:
    timing = Timing(delay=0.1)
    stamps = [*STAMPS[:10], STAMPS[0] + 10**18, *STAMPS[10:40]]
    found = flat(delivered(timing, stamps=stamps))
    assert [stamp for stamp, _ in found][-20:] == STAMPS[16:36]
