# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Devices err as much as asked, late and rarely as asked, by seed, topic and count alone."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hexapod_sim.channel import Channel, Field, Kind
from hexapod_sim.degradation import Degradation, from_rotation, multiply
from hexapod_sim.quality import PERFECT
from hexapod_sim.sensor_table import SENSORS
from hypothesis import given, settings
from hypothesis import strategies as st

PERIOD = 25_000_000
STAMPS = [PERIOD * step for step in range(2000)]
TRUTH = np.linspace(-1.0, 1.0, 6)


def channel(kind: Kind = 'vector', size: int = 6) -> Channel:
    return Channel('', 'z', ('z',), '', (Field('z', 'z', size, 'm', 1.0, kind=kind),), 'device')


def device(kind: Kind = 'vector', seed: int = 1, topic: str = 'z', size: int = 6, **quality):
    return Degradation(channel(kind, size), topic, replace(PERFECT, **quality), seed)


def measured(made: Degradation, truth: np.ndarray, stamps=STAMPS) -> np.ndarray:
    """Return what stands for the truth at every stamp (samples, n)."""
    found = []
    for stamp in stamps:
        made.sample(stamp, {'z': truth})
        found.append(made.newest['z'])
    return np.array(found)


def test_a_perfect_device_reads_the_truth_bit_for_bit() -> None:
    truth = np.array([-0.0, 1.0 / 3.0, 1e-300, 0.0, 2.0, -1.0])
    made = device(delay=0.05, dropout=0.2)
    assert made.sample(0, {'z': truth}) is False  # it is under way
    assert made.newest['z'].tobytes() == truth.tobytes()


def test_noise_has_its_standard_deviation_and_no_mean() -> None:
    errors = measured(device(noise=0.2), TRUTH) - TRUTH
    # 12000 draws: the standard error of the mean is 0.2 / sqrt(12000) = 0.0018, that of the
    # standard deviation 0.2 / sqrt(24000) = 0.0013; four of them.
    assert abs(errors.mean()) < 0.0073
    assert errors.std() == pytest.approx(0.2, abs=0.0052)
    assert abs(np.corrcoef(errors[:-1, 0], errors[1:, 0])[0, 1]) < 0.1


def test_bias_is_constant_and_differs_between_the_numbers() -> None:
    errors = measured(device(bias=0.3), TRUTH) - TRUTH
    np.testing.assert_allclose(errors - errors[0], 0.0, atol=1e-15)
    assert len(set(errors[0])) == 6
    drawn = [measured(device(bias=0.3, seed=seed), TRUTH, [0]) - TRUTH for seed in range(200)]
    assert np.std(drawn) == pytest.approx(0.3, abs=0.025)  # 1200 draws, four standard errors


@given(st.floats(1e-4, 10.0), st.lists(st.floats(-100.0, 100.0), min_size=1, max_size=18))
def test_quantised_values_are_steps_and_within_half_of_one(step: float, truth: list) -> None:
    values = np.array(truth)
    (found,) = measured(device(size=values.size, quantisation=step), values, [0])
    assert np.abs(found - values).max() <= 0.5 * step * (1.0 + 1e-9)
    np.testing.assert_allclose(found / step, np.round(found / step), atol=1e-6)


@given(st.integers(0, 2**64 - 1), st.floats(0.0, 0.9))
def test_errors_depend_on_the_seed_and_not_on_what_is_lost(seed: int, dropout: float) -> None:
    quality = {'seed': seed, 'noise': 0.1, 'bias': 0.2, 'quantisation': 0.001}
    all_there, some = device(**quality), device(dropout=dropout, **quality)
    for stamp in STAMPS[:20]:
        all_there.sample(stamp, {'z': TRUTH})
        if some.sample(stamp, {'z': TRUTH}):
            assert some.newest['z'].tobytes() == all_there.newest['z'].tobytes()


@pytest.mark.parametrize('other', [{'seed': 2}, {'topic': 'z/2'}])
def test_seeds_and_topics_are_independent(other: dict) -> None:
    one = measured(device(noise=1.0), TRUTH) - TRUTH
    two = measured(device(noise=1.0, **other), TRUTH) - TRUTH
    assert abs(np.corrcoef(one.ravel(), two.ravel())[0, 1]) < 0.04  # four standard errors


def test_a_further_field_errs_in_the_proportion_of_its_scale() -> None:
    joints = SENSORS['joint_states']
    made = Degradation(joints, 'joint_states', replace(PERFECT, noise=0.01), 1)
    truth = {'joint_angles': np.zeros(18), 'joint_velocities': np.zeros(18)}
    errors = []
    for stamp in STAMPS[:500]:
        made.sample(stamp, truth)
        errors.append([made.newest[name] for name in truth])
    # 9000 draws each: a standard error of the standard deviation is 0.0075 of it; four of them.
    assert np.std(errors, axis=(0, 2)) == pytest.approx([0.01, 0.062], rel=0.03)


@settings(max_examples=50)
@given(st.integers(0, 1000), st.floats(0.0, 0.5), st.floats(0.0, 0.5), st.floats(0.0, 0.5))
def test_orientations_stay_unit_quaternions(seed, noise, bias, step) -> None:
    truth = np.array([0.1, -0.2, 0.3, math.sqrt(1.0 - 0.14)])
    made = device('quaternion', seed, size=4, noise=noise, bias=bias, quantisation=step)
    assert np.linalg.norm(measured(made, truth, [7])) == pytest.approx(1.0, abs=1e-12)


def test_orientation_noise_is_an_angle_about_each_axis() -> None:
    truth = np.array([0.0, 0.0, math.sin(0.4), math.cos(0.4)])
    turned = measured(device('quaternion', 3, size=4, noise=0.05), truth)
    inverse = truth * np.array([-1.0, -1.0, -1.0, 1.0])
    # For small angles the vector part of the rotation between them is half the rotation vector.
    errors = 2.0 * np.array([multiply(inverse, q)[:3] for q in turned])
    np.testing.assert_allclose(errors.std(axis=0), 0.05, atol=0.0035)
    assert np.abs(errors.mean(axis=0)).max() < 0.0045


def test_switches_flip_by_chance_and_stay_switches() -> None:
    truth = np.array([0.0, 1.0, 0.0, 1.0, 0.0, 1.0])
    found = measured(device('switch', noise=0.1), truth)
    assert set(found.ravel()) == {0.0, 1.0}
    assert (found != truth).mean() == pytest.approx(0.1, abs=0.011)  # four standard errors


@given(st.lists(st.floats(-3.0, 3.0), min_size=3, max_size=3))
def test_a_rotation_and_its_inverse_cancel(rotation: list[float]) -> None:
    vector = np.array(rotation)
    product = multiply(from_rotation(vector), from_rotation(-vector))
    np.testing.assert_allclose(product, [0.0, 0.0, 0.0, 1.0], atol=1e-12)


def test_a_quarter_turn_about_z() -> None:
    root = math.sqrt(0.5)
    found = from_rotation(np.array([0.0, 0.0, math.pi / 2]))
    np.testing.assert_allclose(found, [0.0, 0.0, root, root], atol=1e-15)


@pytest.mark.parametrize(('delay', 'periods'), [(0.0, 0), (0.025, 1), (0.05, 2), (0.06, 3)])
def test_a_delayed_sample_keeps_its_stamp(delay: float, periods: int) -> None:
    made = device(delay=delay)
    found = [made.stamp_ns for stamp in STAMPS if made.sample(stamp, {'z': TRUTH})]
    assert found == STAMPS[: len(STAMPS) - periods]


@settings(max_examples=20)
@given(st.floats(0.0, 0.9), st.integers(0, 2**63 - 1))
def test_the_share_of_lost_samples_is_the_dropout(dropout: float, seed: int) -> None:
    made = device(seed=seed, dropout=dropout)
    came = sum(made.sample(stamp, {'z': TRUTH}) for stamp in STAMPS[:400])
    assert made.lost + came == 400
    # Five standard errors of a share of 400 are at most 0.125.
    assert made.lost / 400 == pytest.approx(dropout, abs=0.125)


@pytest.mark.parametrize(('rate', 'count'), [(40.0, 400), (20.0, 200), (30.0, 300), (4.0, 40)])
def test_a_lower_rate_leaves_samples_out_evenly(rate: float, count: int) -> None:
    made = device(rate=rate)
    came = [stamp for stamp in STAMPS[:400] if made.sample(stamp, {'z': TRUTH})]
    assert abs(len(came) - count) <= 1
    steps = [(b - a) // PERIOD for a, b in pairwise(came)]
    assert max(steps) - min(steps) <= 1


def test_a_source_that_starts_again_is_followed() -> None:
    made = device(rate=20.0)
    again = [*STAMPS[:400], *STAMPS[:40]]
    assert 219 <= sum(made.sample(stamp, {'z': TRUTH}) for stamp in again) <= 221


def test_a_stamp_of_the_future_holds_nobody_up() -> None:
    made = device(delay=0.1)
    stamps = [*STAMPS[:10], STAMPS[0] + 10**18, *STAMPS[10:40]]
    found = [made.stamp_ns for stamp in stamps if made.sample(stamp, {'z': TRUTH})]
    assert found[-20:] == STAMPS[16:36]
