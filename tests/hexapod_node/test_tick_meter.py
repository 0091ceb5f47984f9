# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Counts and quantiles of lateness, against numpy on all the values."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hexapod_node.tick_meter import LATE_NS, TickMeter


def test_quantiles_are_those_of_the_values_to_a_tenth_of_a_millisecond() -> None:
    meter = TickMeter()
    late_ns = np.random.default_rng(1).exponential(2e6, 5000).astype(int)
    for each in late_ns.tolist():
        meter.add(each)
    for share in (0.5, 0.99):
        exact_ms = np.quantile(late_ns, share, method='inverted_cdf') * 1e-6
        assert exact_ms <= meter.quantile_ms(share) <= exact_ms + 0.1
    assert meter.quantile_ms(1.0) == pytest.approx(late_ns.max() * 1e-6)
    assert meter.jitter_ms == pytest.approx(late_ns.std() * 1e-6)
    assert meter.late_share == np.mean(late_ns > LATE_NS)


def test_a_missed_tick_is_late() -> None:
    meter = TickMeter()
    meter.add(0)
    meter.add(LATE_NS, missed=2)
    assert (meter.ticks, meter.missed, meter.late) == (2, 2, 2)
    assert meter.late_share == 0.5


def test_a_pause_beyond_the_histogram_keeps_its_length() -> None:
    meter = TickMeter()
    meter.add(3_000_000_000)
    assert meter.quantile_ms(0.5) == pytest.approx(3000.0)
    assert meter.values()['lateness_max_ms'] == '3000.00'


def test_a_restart_forgets() -> None:
    meter = TickMeter()
    meter.add(LATE_NS + 1, missed=1)
    meter.restart()
    assert (meter.ticks, meter.missed, meter.late_share) == (0, 0, 0.0)
    assert math.isnan(meter.quantile_ms(0.5))
    assert math.isnan(meter.jitter_ms)
