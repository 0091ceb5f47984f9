# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import pytest
from ros2_mini.rate import RateMeter, table

MILLISECOND = 1_000_000


def fed(times_ms: list[int], window: int = 10) -> RateMeter:
    meter = RateMeter(window)
    for time in times_ms:
        meter.add(time * MILLISECOND)
    return meter


def test_statistics_of_periods():
    # Periods of 100 and 300 ms: the mean is 0.2 s, so 5 Hz, and each is 0.1 s off the mean.
    found = fed([1000, 1100, 1400]).take()
    assert str(found) == (
        'average rate: 5.000\n\tmin: 0.100s max: 0.300s std dev: 0.10000s window: 2'
    )


def test_nothing_to_say_without_news():
    meter = fed([1000])
    assert meter.take() is None
    meter.add(1100 * MILLISECOND)
    assert meter.take() is not None
    assert meter.take() is None


def test_window_forgets_the_oldest():
    assert fed([1000, 2000, 2100, 2200], window=2).take().rate == pytest.approx(10.0)


def test_time_that_goes_back_starts_over():
    assert fed([1000, 1100, 50]).take() is None
    assert fed([1000, 1100, 50, 250]).take().rate == pytest.approx(5.0)
    assert fed([0, 0, 1000]).take() is None


def test_table_of_topics():
    lines = table({'/a': fed([1000, 1100]).take()}).splitlines()
    assert lines[0].split() == ['topic', 'rate', 'min_delta', 'max_delta', 'std_dev', 'window']
    assert lines[2].split() == ['/a', '10.000', '0.100', '0.100', '0.00000', '1']
